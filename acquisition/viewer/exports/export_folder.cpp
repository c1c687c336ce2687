#include "acquisition/viewer/exports/export_folder.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

using reconstruct::FileDescriptor;
using reconstruct::SampleError;

constexpr const char* kRecordName = "export.json";
const std::string kUnfinished = ".unfinished-";
constexpr std::uintmax_t kMostRecordBytes = 1 << 20;

/// The kernel takes the lock back when its owner dies.
FileDescriptor locked(const fs::path& folder) {
  FileDescriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!opened.is_open() || ::flock(opened.get(), LOCK_EX | LOCK_NB) != 0) return {};
  return opened;
}

std::optional<ExportRecord> finished_in(const fs::path& folder) {
  const std::string id = folder.filename().string();
  std::error_code error;
  if (!is_export_id(id) || !fs::is_directory(fs::symlink_status(folder, error))) {
    return std::nullopt;
  }
  const fs::path file = folder / kRecordName;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > kMostRecordBytes) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  return export_record({std::istreambuf_iterator<char>(in), {}}, id);
}

}  // namespace

UnfinishedExport::UnfinishedExport(fs::path exports, const std::string& id)
    : exports_(std::move(exports)), path_(exports_ / (kUnfinished + id)) {
  std::error_code error;
  if (!fs::create_directory(path_, error) || error) {
    throw SampleError(path_.string() + ": the folder can't be made" +
                      (error ? ": " + error.message() : ""));
  }
  lock_ = locked(path_);
}

UnfinishedExport::~UnfinishedExport() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

void UnfinishedExport::publish(const ExportRecord& record) {
  reconstruct::write_durably(path_ / kRecordName,
                             reconstruct::json_text(to_json(record), 2) + '\n');
  const fs::path name = exports_ / record.id;
  std::error_code error;
  fs::rename(path_, name, error);
  if (error) {
    throw SampleError(name.string() + ": the export can't be put there: " + error.message());
  }
  path_.clear();
  reconstruct::sync_folder(exports_);
}

std::vector<ExportRecord> ExportFolder::sweep() const {
  std::vector<fs::path> leftovers;
  std::vector<ExportRecord> finished;
  std::error_code error;
  for (auto entry = fs::directory_iterator(path_, error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(kUnfinished) && is_export_id(name.substr(kUnfinished.size()))) {
      leftovers.push_back(entry->path());
    } else if (auto record = finished_in(entry->path())) {
      finished.push_back(*std::move(record));
    }
  }
  for (const fs::path& leftover : leftovers) {
    const FileDescriptor lock = locked(leftover);
    if (lock.is_open()) fs::remove_all(leftover, error);
  }
  std::sort(finished.begin(), finished.end(),
            [](const ExportRecord& a, const ExportRecord& b) { return a.id < b.id; });
  return finished;
}

std::unique_ptr<UnfinishedExport> ExportFolder::begin(const std::string& id) const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) {
    throw SampleError(path_.string() + ": the folder of exports can't be made: " + error.message() +
                      "; choose another by service.exports");
  }
  return std::make_unique<UnfinishedExport>(path_, id);
}

void ExportFolder::remove(const ExportRecord& record) const {
  std::error_code ignored;
  if (is_export_id(record.id)) fs::remove_all(path_ / record.id, ignored);
}

std::uint64_t ExportFolder::free_bytes() const {
  std::error_code error;
  for (fs::path at = path_; !at.empty(); at = at.parent_path()) {
    const fs::space_info space = fs::space(at, error);
    if (!error) return space.available;
    if (at == at.root_path()) break;
  }
  return 0;
}

}  // namespace biotomy::acquisition
