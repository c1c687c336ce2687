#include "tests/faults/recorded_disk.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace biotomy::tests {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSector = 512;

std::pair<std::string, std::string> folder_and_name(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? std::pair(std::string(), path)
                                    : std::pair(path.substr(0, slash), path.substr(slash + 1));
}

bool toss(std::mt19937& random) {
  return std::uniform_int_distribution<int>(0, 1)(random) == 1;
}

/// Bytes from a log, in their order.
class LogReader {
 public:
  explicit LogReader(const fs::path& log) {
    std::ifstream in(log, std::ios::binary);
    if (!in) throw std::runtime_error(log.string() + " cannot be read");
    bytes_ = {std::istreambuf_iterator<char>(in), {}};
  }

  bool at_end() const { return place_ == bytes_.size(); }

  std::string take(std::size_t size) {
    if (size > bytes_.size() - place_) throw std::runtime_error("the log of the disk is cut off");
    place_ += size;
    return bytes_.substr(place_ - size, size);
  }

 private:
  std::string bytes_;
  std::size_t place_ = 0;
};

/// A file's bytes with a write in them; what lies between is zero.
void put(std::string& bytes, std::uint64_t offset, const std::string& data) {
  bytes.resize(std::max<std::size_t>(bytes.size(), offset + data.size()), '\0');
  bytes.replace(offset, data.size(), data);
}

/// A write of which each sector is done or not.
void put_torn(std::string& bytes, std::uint64_t offset, const std::string& data,
              std::mt19937& random) {
  for (std::size_t begin = 0; begin < data.size();) {
    const std::size_t size = std::min(
        kSector - static_cast<std::size_t>((offset + begin) % kSector), data.size() - begin);
    if (toss(random)) put(bytes, offset + begin, data.substr(begin, size));
    begin += size;
  }
}

}  // namespace

RecordedDisk::RecordedDisk(const fs::path& log) {
  folders_[""];
  std::size_t start = 0;
  for (LogReader in(log); !in.at_end();) {
    DiskRecord record;
    const std::string head = in.take(sizeof record);
    std::copy(head.begin(), head.end(), reinterpret_cast<char*>(&record));
    const std::string path = in.take(record.path_size);
    const std::string to = in.take(record.to_size);
    const std::size_t call = calls_.size();
    calls_.push_back({record.call, record.time_ns, path});
    if (record.call == DiskCall::start) start = call;
    if (record.call == DiskCall::sync || record.call == DiskCall::failed_sync) {
      sync(call, start + record.offset, record.node, path, record.call == DiskCall::failed_sync);
    } else {
      apply(call, record, path, to, in.take(record.data_size));
    }
  }
}

std::size_t RecordedDisk::file_of(std::uint64_t node) {
  const auto [place, is_new] = file_by_node_.try_emplace(node, files_.size());
  if (is_new) files_.emplace_back();
  return place->second;
}

void RecordedDisk::apply(std::size_t call, const DiskRecord& record, const std::string& path,
                         const std::string& to, std::string data) {
  const auto [folder, name] = folder_and_name(path);
  switch (record.call) {
    case DiskCall::start:
    case DiskCall::sync:
    case DiskCall::failed_sync:
      break;
    case DiskCall::create:
      file_by_node_.erase(record.node);  // the number was another file's, which is gone
      folders_[folder].push_back(
          {.call = call, .lost = "", .gained = name, .file = file_of(record.node)});
      break;
    case DiskCall::write:
    case DiskCall::truncate:
      files_[file_of(record.node)].push_back({.call = call,
                                              .is_truncate = record.call == DiskCall::truncate,
                                              .offset = record.offset,
                                              .data = std::move(data)});
      break;
    case DiskCall::rename: {
      const auto [to_folder, to_name] = folder_and_name(to);
      if (to_folder != folder) throw std::runtime_error("a rename from folder to folder: " + path);
      folders_[folder].push_back(
          {.call = call, .lost = name, .gained = to_name, .file = file_of(record.node)});
      break;
    }
    case DiskCall::remove:
      folders_[folder].push_back({.call = call, .lost = name, .gained = ""});
      break;
    case DiskCall::make_folder:
      if (!path.empty()) {
        folders_[folder].push_back({.call = call, .lost = "", .gained = name, .is_folder = true});
      }
      folders_[path];
      break;
  }
}

void RecordedDisk::sync(std::size_t call, std::size_t before, std::uint64_t node,
                        const std::string& path, bool failed) {
  const auto cover = [&](auto& changes) {
    for (auto& change : changes) {
      if (change.call < before && change.lasts_from == kNotYet) {
        change.lasts_from = failed ? kNever : call;
      }
    }
  };
  const auto folder = folders_.find(path);
  const bool of_folder = folder != folders_.end();
  const std::size_t file = of_folder ? 0 : file_of(node);
  if (!failed) syncs_.push_back({call, before, of_folder, file});
  if (of_folder) {
    cover(folder->second);
  } else {
    cover(files_[file]);
  }
}

RecordedDisk RecordedDisk::without_sync(std::size_t call) const {
  RecordedDisk other = *this;
  const auto missing = std::find_if(syncs_.begin(), syncs_.end(),
                                    [&](const Sync& sync) { return sync.call == call; });
  if (missing == syncs_.end()) throw std::runtime_error("this call was no sync");
  // What it made last does so only from the next sync of the same on.
  const auto next = std::find_if(missing + 1, syncs_.end(), [&](const Sync& sync) {
    return sync.of_folder == missing->of_folder && sync.file == missing->file &&
           calls_[sync.call].path == calls_[call].path;
  });
  const std::size_t later = next != syncs_.end() ? next->call : kNotYet;
  const auto put_off = [&](auto& changes) {
    for (auto& change : changes) {
      if (change.lasts_from == call) change.lasts_from = later;
    }
  };
  if (missing->of_folder) {
    put_off(other.folders_.at(calls_[call].path));
  } else {
    put_off(other.files_[missing->file]);
  }
  return other;
}

void RecordedDisk::write_state(std::size_t cut, PowerLoss loss, std::mt19937& random,
                               const fs::path& folder) const {
  fs::create_directory(folder);
  write_folder("", cut, loss, random, folder);
}

void RecordedDisk::write_folder(const std::string& path, std::size_t cut, PowerLoss loss,
                                Chooser& random, const fs::path& folder) const {
  std::map<std::string, const Entry*> names;
  for (const Entry& entry : folders_.at(path)) {
    if (entry.call >= cut) break;
    const bool lasts = entry.lasts_from < cut;
    if (!lasts && (loss == PowerLoss::everything || (loss == PowerLoss::random && toss(random)))) {
      continue;
    }
    names.erase(entry.lost);
    if (!entry.gained.empty()) names[entry.gained] = &entry;
  }
  for (const auto& [name, entry] : names) {
    if (entry->is_folder) {
      fs::create_directory(folder / name);
      write_folder(path.empty() ? name : path + "/" + name, cut, loss, random, folder / name);
    } else {
      std::ofstream(folder / name, std::ios::binary) << content(entry->file, cut, loss, random);
    }
  }
}

std::string RecordedDisk::content(std::size_t file, std::size_t cut, PowerLoss loss,
                                  Chooser& random) const {
  std::string bytes;
  for (const Change& change : files_[file]) {
    if (change.call >= cut) break;
    const bool whole = change.lasts_from < cut || loss == PowerLoss::nothing;
    if (!whole && loss == PowerLoss::everything) continue;
    const int fate = whole                     ? 0
                     : loss == PowerLoss::data ? 1
                                               : std::uniform_int_distribution<int>(0, 3)(random);
    if (change.is_truncate) {
      if (fate < 2) bytes.resize(change.offset, '\0');
    } else if (fate == 0) {
      put(bytes, change.offset, change.data);
    } else if (fate == 1) {
      bytes.resize(std::max<std::size_t>(bytes.size(), change.offset + change.data.size()), '\0');
    } else if (fate == 2) {
      put_torn(bytes, change.offset, change.data, random);
    }
  }
  return bytes;
}

}  // namespace biotomy::tests
