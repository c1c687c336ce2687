// Appends to a sample's volume what its layer files complete, as the daemon does while it grinds.
// usage: append_layers SAMPLE LAYERS

#include <cstdlib>
#include <exception>
#include <iostream>

#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume_writer.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const auto sample = biotomy::reconstruct::SampleFolder::open(argv[1]);
    // Bands of two layers, as of the samples that the tests import; a volume that is there keeps
    // its.
    biotomy::reconstruct::VolumeWriter volume(sample, {{2, 16, 16}, {2, 32, 32}});
    volume.append(std::atoll(argv[2]), true);
  } catch (const std::exception& error) {
    std::cerr << "append_layers: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
