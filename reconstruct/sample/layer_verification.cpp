#include "reconstruct/sample/layer_verification.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <string>
#include <system_error>

#include <oneapi/tbb/parallel_for.h>

#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_image.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

/// The files in `layers/`, relative to the sample folder, in order. Hidden ones were never
/// finished.
std::vector<std::string> layer_files(const SampleFolder& sample) {
  std::vector<std::string> files;
  std::error_code error;
  const fs::path folder = sample.layer_path(1).parent_path();
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().front() != '.') {
      files.push_back(entry.path().lexically_relative(sample.path()).string());
    }
  }
  if (error) {
    throw SampleError(folder.string() + ": cannot be listed: " + error.message());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void find_missing_layers(const SampleFolder& sample, bool all_expected,
                         const VerificationListener& listener) {
  std::vector<std::int64_t> missing;
  std::int64_t last = 0;
  const std::int64_t layers = sample.description().cuboid.size.z;
  for (std::int64_t layer = 1; layer <= layers; ++layer) {
    std::error_code error;
    if (fs::exists(sample.layer_path(layer), error)) {
      last = layer;
    } else {
      missing.push_back(layer);
    }
  }
  for (const std::int64_t layer : missing) {
    if (all_expected || layer < last) {
      listener.found({sample.layer_path(layer), "is missing"});
    }
  }
}

/// The hash of each file that has a record.
std::map<std::string, std::string> by_file(const std::vector<LayerHash>& records) {
  std::map<std::string, std::string> recorded;
  for (const LayerHash& record : records) {
    recorded[record.file] = record.sha256;
  }
  return recorded;
}

/// Of the files, which are in order, that of the deepest layer; empty when none is a layer's.
std::string deepest_of(const std::vector<std::string>& files, const SampleFolder& sample) {
  for (std::int64_t layer = sample.description().cuboid.size.z; layer >= 1; --layer) {
    std::string name = sample.layer_path(layer).lexically_relative(sample.path()).string();
    if (std::binary_search(files.begin(), files.end(), name)) {
      return name;
    }
  }
  return {};
}

/// What is wrong with a file that is there; empty when nothing is.
std::string fault_of(const fs::path& path, const std::string* recorded) {
  try {
    if (recorded == nullptr) {
      read_layer_image(path);
      return {};
    }
    const std::string found = sha256_of_file(path);
    return found == *recorded ? std::string()
                              : "is not what was stored: its SHA-256 is " + found +
                                    ", its record says " + *recorded;
  } catch (const SampleError& error) {
    return std::string("cannot be read: ") + error.what();
  }
}

}  // namespace

std::int64_t verify_layers(const SampleFolder& sample, const std::vector<LayerHash>& records,
                           bool all_expected, const VerificationListener& listener,
                           const SampleGrowth& growth) {
  find_missing_layers(sample, all_expected, listener);
  for (const LayerHash& record : records) {
    std::error_code error;
    if (!fs::exists(sample.path() / record.file, error)) {
      listener.found({sample.path() / record.file, "has a record but is not there"});
    }
  }
  const std::vector<std::string> files = layer_files(sample);
  std::map<std::string, std::string> recorded = by_file(records);
  std::string unrecorded_yet;
  if (std::any_of(files.begin(), files.end(),
                  [&](const std::string& file) { return !recorded.contains(file); }) &&
      growth.is_seen()) {
    recorded = by_file(growth.records());
    unrecorded_yet = deepest_of(files, sample);
  }
  if (recorded.empty() && (files.size() > 1 || !growth.is_seen())) {
    listener.found({sample.path(), "has no records of its layers: they can only be decoded"});
  }
  std::mutex mutex;
  std::int64_t done = 0;
  tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
    const auto record = recorded.find(files[i]);
    const bool unknown = record == recorded.end();
    const fs::path path = sample.path() / files[i];
    const std::string fault = fault_of(path, unknown ? nullptr : &record->second);
    const std::scoped_lock lock(mutex);
    if (unknown && !recorded.empty() && files[i] != unrecorded_yet) {
      listener.found({path, "has no record"});
    }
    if (!fault.empty()) {
      listener.found({path, fault});
    }
    listener.progress(++done, static_cast<std::int64_t>(files.size()));
  });
  return static_cast<std::int64_t>(files.size());
}

}  // namespace biotomy::reconstruct
