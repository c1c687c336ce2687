#include "reconstruct/import/partial_import.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "reconstruct/absolute_folder.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/disk/folder_lock.hpp"
#include "reconstruct/disk/folder_swap.hpp"
#include "reconstruct/disk/free_place.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/import/import_request.hpp"
#include "reconstruct/sample/layer_hashes.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;

constexpr const char* kRequestName = "request.json";
constexpr const char* kSampleName = "sample";

std::string file_of(const SampleFolder& sample, std::int64_t layer) {
  return sample.layer_path(layer).lexically_relative(sample.path()).string();
}

/// Whether layers of the one can stand beside layers of the other.
bool are_alike(const SampleDescription& a, const SampleDescription& b) {
  return a.cuboid.size == b.cuboid.size && a.bits == b.bits;
}

}  // namespace

bool holds_import(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kRequestName, error) && fs::exists(folder / kSampleName, error);
}

PartialImport::PartialImport(const fs::path& output, const SampleDescription& description,
                             const json& asked, bool restart)
    : output_(absolute_folder(output)),
      folder_(output_.parent_path() / ("." + output_.filename().string() + ".partial")) {
  refuse_if_taken();
  lock_ = make_locked_folder(
      folder_,
      output_.string() + ": an export or another import of it is at work; wait for its end");
  if (restart || !take_up(description, asked)) {
    try {
      begin(description, asked);
    } catch (...) {
      discard();
      throw;
    }
  }
  hashes_file_ = FileDescriptor(
      ::open(hashes_path().c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644));
  if (!hashes_file_.is_open()) {
    throw SampleError(hashes_path().string() + ": cannot open it: " + std::strerror(errno));
  }
}

void PartialImport::refuse_if_taken() const {
  try {
    check_place_is_free(output_);
  } catch (const SampleError&) {
    std::error_code error;
    if (fs::exists(folder_ / kRequestName, error) && !fs::exists(folder_ / kSampleName, error)) {
      fs::remove_all(folder_, error);  // of the import that made the output and was then killed
    }
    throw;
  }
}

bool PartialImport::take_up(const SampleDescription& description, const json& asked) {
  if (!holds_import(folder_)) {
    return false;  // nothing was begun, or all was finished but the removal of this folder
  }
  const json begun = begun_request();
  open_begun_sample();
  remove_unfinished_writes(sample_->path());
  take_up_hashes();
  if (stored_.empty()) {
    return false;  // there is nothing to keep, and the images may have become others meanwhile
  }
  const auto stored = [this](std::int64_t layer) { return is_stored(layer); };
  std::optional<std::string> difference = import_difference(begun, asked, stored);
  if (!difference && !are_alike(sample_->description(), description)) {
    difference = "the size or the bits of the images";
  }
  if (difference) {
    throw SampleError(output_.string() + ": another import of it was begun, in which " +
                      *difference +
                      " was another; repeat that to go on, or give --restart to begin anew");
  }
  if (begun != asked) {
    write_durably(folder_ / kRequestName, asked.dump(1) + "\n");
  }
  return true;
}

json PartialImport::begun_request() const {
  json begun = json::parse(std::ifstream(folder_ / kRequestName, std::ios::binary), nullptr,
                           /*allow_exceptions=*/false);
  if (!begun.is_object()) {
    throw SampleError((folder_ / kRequestName).string() +
                      ": is damaged; give --restart to begin anew");
  }
  return begun;
}

void PartialImport::open_begun_sample() {
  try {
    sample_ = SampleFolder::open(folder_ / kSampleName);
  } catch (const SampleError& error) {
    throw SampleError(std::string(error.what()) + "; give --restart to begin the import anew");
  }
}

void PartialImport::take_up_hashes() {
  std::error_code error;
  if (!fs::exists(hashes_path(), error)) {
    return;
  }
  std::vector<LayerHash> hashes = readable_layer_hashes(hashes_path());
  std::erase_if(hashes, [&](const LayerHash& each) {
    return !fs::exists(sample_->path() / each.file, error);  // its name did not reach the disk
  });
  for (const LayerHash& each : hashes) {
    stored_[each.file] = each.sha256;
  }
  write_durably(hashes_path(), layer_hash_lines(hashes));  // without lines that were cut off
}

void PartialImport::begin(const SampleDescription& description, const json& asked) {
  std::error_code error;
  // First: killed in here, nobody takes what is left for an import that can be taken up.
  if (fs::remove(folder_ / kRequestName, error)) {
    sync_folder(folder_);
  }
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    remove_folder(entry.path());
  }
  sample_ = SampleFolder::create(folder_ / kSampleName, description);
  write_durably(folder_ / kRequestName, asked.dump(1) + "\n");  // last: now it can be taken up
}

bool PartialImport::is_stored(std::int64_t layer) const {
  const std::scoped_lock lock(mutex_);
  return stored_.contains(file_of(*sample_, layer));
}

std::int64_t PartialImport::stored_layers() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<std::int64_t>(stored_.size());
}

void PartialImport::add_stored(std::int64_t layer, const std::string& sha256) {
  const LayerHash hash{file_of(*sample_, layer), sha256};
  const std::string line = layer_hash_lines({hash});
  const std::scoped_lock lock(mutex_);
  if (::write(hashes_file_.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    throw SampleError(hashes_path().string() + ": cannot write it: " + std::strerror(errno));
  }
  stored_[hash.file] = hash.sha256;
}

void PartialImport::sync() {
  sync_folder(sample_->layer_path(1).parent_path());
  if (::fdatasync(hashes_file_.get()) != 0) {
    throw SampleError(hashes_path().string() + ": cannot write it: " + std::strerror(errno));
  }
}

fs::path PartialImport::finish() {
  sync();
  std::vector<LayerHash> hashes;
  for (const auto& [file, sha256] : stored_) {
    hashes.push_back({file, sha256});
  }
  write_durably(sample_->hashes_path(), layer_hash_lines(hashes));
  std::error_code error;
  fs::rename(sample_->path(), output_, error);  // takes the place of an empty folder, of no other
  if (error) {
    refuse_if_taken();
    throw SampleError(output_.string() +
                      ": cannot give the finished sample its name: " + error.message());
  }
  try {
    sync_folder(output_.parent_path());
  } catch (const SampleError&) {
    fs::rename(output_, sample_->path(), error);  // to where the same command goes on from
    throw;
  }
  discard();
  return output_;
}

void PartialImport::discard() noexcept {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace biotomy::reconstruct
