#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/faults/disk_record.hpp"

namespace biotomy::tests {

/// What a cut of the power takes of that which was done and not synced.
enum class PowerLoss {
  nothing,     ///< as when only the program is killed
  everything,  ///< the disk holds what was synced and no more
  data,        ///< names and sizes stay; where the data should be are zeros
  random,      ///< each call by itself stays or is lost, a write also in part or as zeros
};

/// What a program did to a folder, call by call, as disk_recorder.cpp wrote it down, and the states
/// in which a cut of the power may leave the folder.
///
/// A file's data last once the file was synced; a name once its folder was. Nothing else does: no
/// order between calls is promised, a rename is whole or not done, and a sync covers what was done
/// before it began. What a failed sync should have covered is lost for ever, though it can still be
/// read until the power is cut, and the next sync says that all is well: so Linux's page cache does
/// it (Rebello et al., "Can Applications Recover from fsync Failures?", USENIX ATC 2020; known by
/// PostgreSQL's "fsyncgate" of 2018). This is less than file systems give, and all that POSIX says.
/// The method is that of ALICE (Pillai et al., "All File Systems Are Not Created Equal", OSDI 2014)
/// and CrashMonkey (Mohan et al., "Finding Crash-Consistency Bugs with Bounded Black-Box Crash
/// Testing", OSDI 2018).
class RecordedDisk {
 public:
  struct Call {
    DiskCall kind;
    std::int64_t time_ns;
    std::string path;  ///< below the folder
  };

  /// Throws std::runtime_error when the log makes no sense.
  explicit RecordedDisk(const std::filesystem::path& log);

  const std::vector<Call>& calls() const { return calls_; }

  /// The same as if this sync, by its place in `calls`, had done nothing.
  RecordedDisk without_sync(std::size_t call) const;

  /// Makes `folder`, which must not be there, as the power may leave it when it is cut after the
  /// first `cut` calls.
  void write_state(std::size_t cut, PowerLoss loss, std::mt19937& random,
                   const std::filesystem::path& folder) const;

 private:
  static constexpr std::size_t kNotYet = SIZE_MAX;
  static constexpr std::size_t kNever = SIZE_MAX - 1;

  /// A write to a file, or a change of its size.
  struct Change {
    std::size_t call = 0;
    bool is_truncate = false;
    std::uint64_t offset = 0;
    std::string data;
    std::size_t lasts_from = kNotYet;  ///< the call of the sync that made it last
  };
  /// An entry that a folder gets, loses, or both.
  struct Entry {
    std::size_t call = 0;
    std::string lost;        ///< a name in the folder; empty: none
    std::string gained;      ///< likewise
    std::size_t file = 0;    ///< what `gained` names, if it is a file
    bool is_folder = false;  ///< else
    std::size_t lasts_from = kNotYet;
  };
  using Chooser = std::mt19937;

  std::size_t file_of(std::uint64_t node);
  void apply(std::size_t call, const DiskRecord& record, const std::string& path,
             const std::string& to, std::string data);
  void sync(std::size_t call, std::size_t before, std::uint64_t node, const std::string& path,
            bool failed);
  void write_folder(const std::string& path, std::size_t cut, PowerLoss loss, Chooser& random,
                    const std::filesystem::path& folder) const;
  std::string content(std::size_t file, std::size_t cut, PowerLoss loss, Chooser& random) const;

  std::vector<Call> calls_;
  struct Sync {
    std::size_t call = 0;
    std::size_t before = 0;
    bool of_folder = false;
    std::size_t file = 0;
  };
  std::vector<Sync> syncs_;
  std::vector<std::vector<Change>> files_;
  std::map<std::string, std::vector<Entry>> folders_;  ///< by path
  std::map<std::uint64_t, std::size_t> file_by_node_;
};

}  // namespace biotomy::tests
