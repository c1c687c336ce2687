// What the chunks that a section touches cost by themselves: how many there are and their bytes,
// counted for every pixel apart from the sampler, and the time to read just those bytes, and to
// decode them, with all cores. The bounds that `biotomy section` is held against. Prints a line of
// JSON a plane.
//
//   touched_chunks SAMPLE --planes FILE [--only NAME] [--level 0] [--pixel MICROMETRES]
//                  [--repetitions 0] [--cold] [--threads N]

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/pyramid.hpp"
#include "reconstruct/store/zarr_array.hpp"
#include "tests/bench/chunk_ranges.hpp"
#include "tests/bench/exit_code.hpp"
#include "tests/bench/named_planes.hpp"
#include "tests/bench/section_pixels.hpp"

namespace {

namespace fs = std::filesystem;
using namespace biotomy::bench;
using namespace biotomy::reconstruct;
using Bytes = std::vector<std::byte>;
using Clock = std::chrono::steady_clock;

struct Options {
  std::string sample;
  std::string planes;
  std::string only;
  std::size_t level = 0;
  double pixel = 0.0;
  int repetitions = 0;
  bool cold = false;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
};

constexpr std::uint64_t kBatchBytes = std::uint64_t{256} << 20;

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw SampleError(path.string() + ": cannot be opened");
  }
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

double seconds(const std::function<void()>& work) {
  const auto start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// `work(i)` for each i below `count`, in order, by `threads` threads.
void share_out(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto take = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        work(i);
      }
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < threads; ++i) {
      others.emplace_back(take);
    }
    take();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

/// Bytes of one file that follow each other.
struct Run {
  std::size_t file;
  std::uint64_t offset;
  std::uint64_t length;
  std::size_t place;  ///< of the first byte in the batch's memory
};

std::vector<Run> runs_of(std::span<const ChunkBytes> chunks) {
  std::vector<Run> runs;
  std::size_t place = 0;
  for (const ChunkBytes& chunk : chunks) {
    if (!runs.empty() && runs.back().file == chunk.file &&
        runs.back().offset + runs.back().length == chunk.offset) {
      runs.back().length += chunk.length;
    } else {
      runs.push_back({chunk.file, chunk.offset, chunk.length, place});
    }
    place += chunk.length;
  }
  return runs;
}

void read_fully(int descriptor, std::uint64_t offset, std::span<std::byte> out,
                const fs::path& file) {
  while (!out.empty()) {
    const ssize_t got = ::pread(descriptor, out.data(), out.size(), static_cast<off_t>(offset));
    if (got <= 0) {
      throw SampleError(file.string() + ": " +
                        (got < 0 ? std::strerror(errno) : "ends before its index says"));
    }
    offset += static_cast<std::uint64_t>(got);
    out = out.subspan(static_cast<std::size_t>(got));
  }
}

/// The files of some chunks, open.
class OpenShards {
 public:
  explicit OpenShards(const ChunkRanges& ranges) : ranges_(ranges) {
    for (const fs::path& file : ranges.files) {
      FileDescriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
      if (!descriptor.is_open()) {
        throw SampleError(file.string() + ": cannot be opened: " + std::strerror(errno));
      }
      descriptors_.push_back(std::move(descriptor));
    }
  }

  /// Takes the files' bytes out of the machine's memory.
  void forget() const {
    for (const FileDescriptor& descriptor : descriptors_) {
      ::fdatasync(descriptor.get());
      ::posix_fadvise(descriptor.get(), 0, 0, POSIX_FADV_DONTNEED);
    }
  }

  void read(const Run& run, std::span<std::byte> memory) const {
    read_fully(descriptors_[run.file].get(), run.offset, memory.subspan(run.place, run.length),
               ranges_.files[run.file]);
  }

 private:
  const ChunkRanges& ranges_;
  std::vector<FileDescriptor> descriptors_;
};

struct Times {
  double read = 0.0;
  double decode = 0.0;
};

/// Reads and decodes all chunks once, batch by batch so that memory stays bounded.
Times read_and_decode(const ChunkRanges& ranges, const OpenShards& shards, const ChunkCodec& codec,
                      unsigned threads, Bytes& memory) {
  Times times;
  for (std::size_t first = 0; first < ranges.chunks.size();) {
    std::size_t end = first;
    std::uint64_t bytes = 0;
    while (end < ranges.chunks.size() && bytes + ranges.chunks[end].length <= memory.size()) {
      bytes += ranges.chunks[end++].length;
    }
    const auto batch = std::span(ranges.chunks).subspan(first, end - first);
    const std::vector<Run> runs = runs_of(batch);
    times.read += seconds([&] {
      share_out(threads, runs.size(), [&](std::size_t i) { shards.read(runs[i], memory); });
    });
    std::vector<std::size_t> places(1, 0);
    for (const ChunkBytes& chunk : batch) {
      places.push_back(places.back() + chunk.length);
    }
    times.decode += seconds([&] {
      share_out(threads, batch.size(), [&](std::size_t i) {
        static thread_local Bytes voxels;
        voxels.resize(codec.chunk_bytes());
        codec.decode(std::span(memory).subspan(places[i], batch[i].length), voxels);
      });
    });
    first = end;
  }
  return times;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

nlohmann::ordered_json measure(const NamedPlane& plane, const Cuboid& cuboid,
                               const PyramidLevel& level, const fs::path& folder,
                               const ZarrArray& array, const Options& options) {
  const double finest = std::min({level.spacing.x, level.spacing.y, level.spacing.z});
  const SectionPixels pixels =
      section_pixels(plane, cuboid, options.pixel > 0.0 ? options.pixel : finest);
  const std::vector<ChunkPlace> places = touched_chunks(pixels, level, array.layout.chunk, 1);
  const ChunkRanges ranges = find_chunks(folder, array, places);
  nlohmann::ordered_json line{
      {"plane", plane.name},     {"columns", pixels.columns},      {"rows", pixels.rows},
      {"chunks", places.size()}, {"stored", ranges.chunks.size()}, {"shards", ranges.files.size()},
      {"bytes", ranges.bytes()}};
  if (options.repetitions > 0) {
    const OpenShards shards(ranges);
    const ChunkCodec codec(array.layout, array.bits);
    std::uint64_t longest = 0;
    for (const ChunkBytes& chunk : ranges.chunks) {
      longest = std::max(longest, chunk.length);
    }
    Bytes memory(std::min(ranges.bytes(), std::max(kBatchBytes, longest)));
    std::vector<double> read;
    std::vector<double> decode;
    for (int repetition = 0; repetition < options.repetitions; ++repetition) {
      if (options.cold) {
        shards.forget();
      }
      const Times times = read_and_decode(ranges, shards, codec, options.threads, memory);
      read.push_back(times.read);
      decode.push_back(times.decode);
    }
    line["threads"] = options.threads;
    line["read_s"] = median(read);
    line["decode_s"] = median(decode);
  }
  return line;
}

void run(const Options& options) {
  const fs::path volume = SampleFolder::open(options.sample).volume_path();
  const fs::path group_file = volume / "zarr.json";
  const VolumeMetadata group = parse_group_metadata(read_text(group_file), group_file.string());
  if (options.level >= group.levels.size()) {
    throw InvalidRequest("--level " + std::to_string(options.level) +
                         ": the volume has levels 0 to " + std::to_string(group.levels.size() - 1));
  }
  const auto array_of = [&](std::size_t level) {
    const fs::path file = volume / level_path(static_cast<int>(level)) / "zarr.json";
    return parse_array_metadata(read_text(file), file.string());
  };
  const Cuboid cuboid{array_of(0).size, group.spacing};
  const PyramidLevel level = pyramid_level(cuboid, group.levels[options.level]);
  const fs::path folder = volume / level_path(static_cast<int>(options.level));
  for (const NamedPlane& plane : read_planes(options.planes, options.only)) {
    std::cout << measure(plane, cuboid, level, folder, array_of(options.level), options).dump()
              << std::endl;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Counts, reads and decodes the chunks that sections touch."};
  Options options;
  app.add_option("SAMPLE", options.sample, "The sample's folder")->required();
  app.add_option("--planes", options.planes, "File of planes, in voxels")->required();
  app.add_option("--only", options.only, "The plane of this name");
  app.add_option("--level", options.level, "Of the pyramid")->capture_default_str();
  app.add_option("--pixel", options.pixel, "Of the picture, micrometres [the level's finest]");
  app.add_option("--repetitions", options.repetitions,
                 "Read and decode so often; the medians are printed")
      ->capture_default_str();
  app.add_flag("--cold", options.cold, "Before each, take the shards out of the page cache");
  app.add_option("--threads", options.threads, "That read and decode")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return exit_code_of("touched_chunks", [&] { run(options); });
}
