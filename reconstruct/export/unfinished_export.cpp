#include "reconstruct/export/unfinished_export.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <unistd.h>

#include "reconstruct/absolute_folder.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/disk/folder_lock.hpp"
#include "reconstruct/disk/folder_swap.hpp"
#include "reconstruct/disk/free_place.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/import/partial_import.hpp"

namespace biotomy::reconstruct {
namespace fs = std::filesystem;

UnfinishedExport::UnfinishedExport(const fs::path& output)
    : output_(absolute_folder(output)),
      folder_(output_.parent_path() / ("." + output_.filename().string() + ".partial")) {
  check_place_is_free(output_);
  create_folders_durably(output_.parent_path());
  lock_ = make_locked_folder(
      folder_,
      output_.string() + ": an import or another export of it is at work; wait for its end");
  if (holds_import(folder_)) {
    throw SampleError(output_.string() + ": an interrupted import of it is kept in " +
                      folder_.string() +
                      ": choose another name, or let the same import go on, or remove that folder");
  }
  for (const auto& entry : fs::directory_iterator(folder_)) {
    remove_folder(entry.path());  // of an export that was killed
  }
}

UnfinishedExport::~UnfinishedExport() {
  if (!finished_) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
}

void UnfinishedExport::finish() {
  // An export is thousands of small files: one sync of their file system is quicker than theirs.
  if (::syncfs(lock_.get()) != 0) {
    throw SampleError(folder_.string() + ": cannot write it to the disk: " + std::strerror(errno));
  }
  std::error_code error;
  fs::rename(folder_, output_, error);
  if (error) {
    check_place_is_free(output_);
    throw SampleError(output_.string() + ": cannot be given its name: " + error.message());
  }
  finished_ = true;
  sync_folder(output_.parent_path());
}

void write_plainly(const fs::path& path, const void* data, std::size_t size) {
  std::ofstream out(path, std::ios::binary);
  out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  out.close();
  if (!out) {
    throw SampleError(path.string() + ": cannot write it; is the disk full?");
  }
}

}  // namespace biotomy::reconstruct
