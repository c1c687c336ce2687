#include <fstream>

#include "reconstruct/sample/sample_folder.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {

bool fuzz_sample_description(FuzzInput input) {
  static const TemporaryFolder kFolder;
  const auto file = kFolder / "sample.toml";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data()),
             static_cast<std::streamsize>(input.size()));
  return accepts(file.string(), [] {
    const auto sample = reconstruct::SampleFolder::open(kFolder.path());
    static const TemporaryFolder kCopies;
    const auto copy = kCopies / "copy";
    reconstruct::SampleFolder::create(copy, sample.description());
    const auto again = reconstruct::SampleFolder::open(copy).description();
    std::filesystem::remove_all(copy);
    require(again.name == sample.description().name && again.notes == sample.description().notes &&
                again.cuboid.size == sample.description().cuboid.size &&
                again.cuboid.spacing == sample.description().cuboid.spacing,
            "a description that was read is written as another");
  });
}

}  // namespace biotomy::tests
