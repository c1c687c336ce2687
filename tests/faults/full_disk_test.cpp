#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/faults/fault.hpp"
#include "tests/faults/folder_content.hpp"
#include "tests/faults/small_sample.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// A program that writes to a disk, which is made to fail at its calls in turn.
class FullDisk : public testing::Test {
 protected:
  using Command = std::vector<std::string>;

  static constexpr std::string_view kPartialImport = ".sample.partial/";

  FullDisk() {
    fs::create_directory(prepared_);
    fs::create_directory(disk_);
  }

  /// What is on the disk before the program begins; put there anew for each run, with the times at
  /// which it was made: by these a series knows its sample again.
  void reset_disk() const {
    fs::remove_all(disk_);
    fs::copy(prepared_, disk_, fs::copy_options::recursive);
    for (const auto& entry : fs::recursive_directory_iterator(prepared_)) {
      fs::last_write_time(disk_ / entry.path().lexically_relative(prepared_),
                          entry.last_write_time());
    }
  }

  Outcome run_on(const Fault& fault, const Command& command) const {
    return run(under(fault, command, counts_), folder_.path());
  }

  /// How often the program that ran last made each call.
  std::map<std::string, std::int64_t> counted_calls() const {
    std::map<std::string, std::int64_t> calls;
    std::ifstream in(counts_);
    for (std::string name; in >> name;) in >> calls[name];
    return calls;
  }

  /// How often the program makes each call when none fails.
  std::map<std::string, std::int64_t> calls_of(const Command& command) {
    reset_disk();
    const Outcome outcome = run_on({disk_}, command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return counted_calls();
  }

  /// Every file is as it was or as it is in one of the whole states that follow, which are in their
  /// order; none is lost, none is left over.
  void expect_no_harm(const std::vector<FolderContent>& states) const {
    const FolderContent after = content_of_folder(disk_);
    for (const auto& [name, bytes] : states.front()) {
      EXPECT_TRUE(after.contains(name)) << name << " is lost";
    }
    for (const auto& [name, bytes] : after) {
      EXPECT_TRUE(is_kept_to_go_on(name) || has(states.begin(), states.end(), name, bytes))
          << name << " is neither what it was nor whole";
    }
    expect_metadata_kept(states, after);
  }

  /// Of an import that was cut off: what it has done, hidden, until it is taken up again.
  static bool is_kept_to_go_on(const std::string& name) {
    return name.compare(0, kPartialImport.size(), kPartialImport) == 0;
  }

  /// What a volume's metadata says is there is there: the files of the state that it belongs to, or
  /// what becomes of them later.
  static void expect_metadata_kept(const std::vector<FolderContent>& states,
                                   const FolderContent& after) {
    const std::string metadata = "sample/volume.ome.zarr/zarr.json";
    if (!after.contains(metadata)) return;
    const auto state = std::find_if(states.begin(), states.end(), [&](const FolderContent& each) {
      return each.contains(metadata) && each.at(metadata) == after.at(metadata);
    });
    ASSERT_NE(state, states.end());
    for (const auto& [name, bytes] : *state) {
      EXPECT_TRUE(after.contains(name) && has(state, states.end(), name, after.at(name)))
          << name << " is promised and not there";
    }
  }

  template <typename State>
  static bool has(State first, State last, const std::string& name, const std::string& bytes) {
    return std::any_of(first, last, [&](const FolderContent& state) {
      const auto file = state.find(name);
      return file != state.end() && file->second == bytes;
    });
  }

  void expect_clear_failure(const Outcome& outcome) const {
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_NE(outcome.errors.find(disk_.string()), std::string::npos) << outcome.errors;
  }

  /// What is on the disk before the command, after each of those that do a part of it, and after
  /// all of it.
  std::vector<FolderContent> states_of(const Command& command,
                                       const std::vector<Command>& parts) const {
    std::vector<FolderContent> states{content_of_folder(prepared_)};
    reset_disk();
    for (const Command& part : parts) {
      EXPECT_EQ(run(part, folder_.path()).exit_code, 0);
      states.push_back(content_of_folder(disk_));
    }
    EXPECT_EQ(run(command, folder_.path()).exit_code, 0);
    states.push_back(content_of_folder(disk_));
    return states;
  }

  /// At most ten of the numbers from 1 to `count`, the first and the last among them.
  static std::vector<std::int64_t> spread(std::int64_t count) {
    constexpr std::int64_t kMost = 10;
    std::vector<std::int64_t> numbers;
    const std::int64_t picks = std::min(count, kMost);
    for (std::int64_t i = 0; i < picks; ++i) {
      numbers.push_back(picks == 1 ? 1 : 1 + i * (count - 1) / (picks - 1));
    }
    return numbers;
  }

  /// Runs the command with its writing calls failing in turn, and again on the sound disk.
  void fail_in_turn(
      const Command& command, const std::vector<Command>& parts = {},
      const std::function<void()>& before_again = [] {}) {
    constexpr std::array kErrors{"ENOSPC", "EIO", "EROFS"};
    const std::vector<FolderContent> states = states_of(command, parts);
    const auto calls = calls_of(command);
    std::size_t runs = 0;
    for (const std::string call : {"create", "mkdir", "write", "sync", "rename"}) {
      for (const std::int64_t at : spread(calls.at(call))) {
        const std::string error = kErrors[runs % kErrors.size()];
        SCOPED_TRACE(call + " " + std::to_string(at) + " of " + std::to_string(calls.at(call)) +
                     " fails with " + error);
        reset_disk();
        const Outcome outcome =
            run_on({.folder = disk_, .call = call, .at = at, .error = error}, command);
        if (counted_calls().at(call) < at) {  // two threads no longer made the same folder
          EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
          EXPECT_EQ(content_of_folder(disk_), states.back());
          continue;
        }
        ++runs;
        expect_clear_failure(outcome);
        expect_no_harm(states);
        if (content_of_folder(disk_) == states.back()) continue;  // done, only not known to last
        before_again();
        const Outcome again = run(command, folder_.path());
        EXPECT_EQ(again.exit_code, 0) << again.errors;
        EXPECT_EQ(content_of_folder(disk_), states.back());
        if (HasFailure()) return;
      }
    }
    EXPECT_GT(runs, 4U);
  }

  /// Runs the command on disks that have room for a part of what it writes.
  void fill_the_disk(
      const Command& command, const std::vector<Command>& parts = {},
      const std::function<void()>& before_again = [] {}) const {
    const std::vector<FolderContent> states = states_of(command, parts);
    std::int64_t bytes = 0;
    for (const auto& [name, content] : states.back()) {
      const bool is_old = has(states.begin(), states.begin() + 1, name, content);
      bytes += is_old ? 0 : static_cast<std::int64_t>(content.size());
    }
    for (const double share : {0.001, 0.3, 0.6, 0.9, 0.99}) {
      SCOPED_TRACE("a disk with room for " + std::to_string(share) + " of it");
      reset_disk();
      const auto space =
          std::max<std::int64_t>(1, static_cast<std::int64_t>(share * static_cast<double>(bytes)));
      expect_clear_failure(run_on({.folder = disk_, .space = space}, command));
      expect_no_harm(states);
      before_again();
      EXPECT_EQ(run(command, folder_.path()).exit_code, 0);
      EXPECT_EQ(content_of_folder(disk_), states.back());
    }
  }

  void write_in_short_pieces(const Command& command) {
    calls_of(command);
    const FolderContent whole = content_of_folder(disk_);
    reset_disk();
    const Outcome outcome = run_on({.folder = disk_, .most_bytes = 97}, command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(content_of_folder(disk_), whole);
  }

  /// The sample in the folder that is copied to the disk.
  void prepare_sample() const {
    write_small_images(images_);
    const Outcome outcome = run(import_command(images_, prepared_ / "sample"), folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }

  /// The same without its volume, but for the first band.
  void prepare_first_band() const {
    prepare_sample();
    fs::remove_all(prepared_ / "sample" / "volume.ome.zarr");
    const Outcome outcome = run({BIOTOMY_APPEND_LAYERS, prepared_ / "sample", "2"}, folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  }

  Command append_to(int layers) const {
    return {BIOTOMY_APPEND_LAYERS, disk_ / "sample", std::to_string(layers)};
  }

  TemporaryFolder folder_;
  fs::path counts_ = folder_ / "counts";
  fs::path images_ = folder_ / "images";
  fs::path prepared_ = folder_ / "prepared";
  fs::path disk_ = folder_ / "disk";
};

TEST_F(FullDisk, AnImportIsWholeOrNotThere) {
  write_small_images(images_);
  std::ofstream(prepared_ / "neighbour") << "precious";
  fail_in_turn(import_command(images_, disk_ / "sample"));
}

TEST_F(FullDisk, AnImportOfWhichAPartFitsIsTakenUpAgain) {
  write_small_images(images_);
  fill_the_disk(import_command(images_, disk_ / "sample"));
}

TEST_F(FullDisk, AnImportTakesShortWritesAndReadsForWhatTheyAre) {
  write_small_images(images_);
  write_in_short_pieces(import_command(images_, disk_ / "sample"));
}

TEST_F(FullDisk, AnAppendLeavesTheBandsThatWereThere) {
  prepare_first_band();
  fail_in_turn(append_to(5), {append_to(4)});
}

TEST_F(FullDisk, AnAppendOfWhichAPartFitsLeavesTheBandsThatWereThere) {
  prepare_first_band();
  fill_the_disk(append_to(5), {append_to(4)});
}

TEST_F(FullDisk, ASectionReplacesAPictureOnlyByAWholeOne) {
  prepare_sample();
  std::ofstream(prepared_ / "picture.png") << "the picture of last week";
  fail_in_turn(section_command(disk_ / "sample", disk_ / "picture.png"));
  fill_the_disk(section_command(disk_ / "sample", disk_ / "picture.png"));
  write_in_short_pieces(section_command(disk_ / "sample", disk_ / "picture.png"));
}

TEST_F(FullDisk, ASeriesLeavesWholeFrames) {
  prepare_sample();
  const Command series{BIOTOMY_TOOL, "series", disk_ / "sample", "rotate", "--axis", "x", "--step",
                       "60",         "-o",     disk_ / "frames"};
  fail_in_turn(series, {}, [this] { fs::remove_all(disk_ / "frames"); });
  fill_the_disk(series, {}, [this] { fs::remove_all(disk_ / "frames"); });
}

TEST_F(FullDisk, AFilmIsWholeOrNotThere) {
  prepare_sample();
  std::ofstream(prepared_ / "film.mp4") << "the film of last week";
  const Command series{
      BIOTOMY_TOOL, "series", disk_ / "sample", "rotate",  "--axis",          "x", "--step",
      "20",         "-o",     disk_ / "frames", "--movie", disk_ / "film.mp4"};
  fail_in_turn(series, {}, [this] { fs::remove_all(disk_ / "frames"); });
  fill_the_disk(series, {}, [this] { fs::remove_all(disk_ / "frames"); });
}

/// A volume that is made anew, on a disk where the old one is told from the new.
class RebuildOnAFaultyDisk : public FullDisk {
 protected:
  RebuildOnAFaultyDisk() {
    prepare_sample();
    const fs::path shard = prepared_ / "sample/volume.ome.zarr/0/c/0/0/0/0";
    EXPECT_TRUE(fs::exists(shard));
    std::ofstream(shard, std::ios::in | std::ios::out) << "damaged, so that old is told from new";
    old_ = content_of_folder(prepared_ / "sample");
    calls_ = calls_of(rebuild_);
    new_ = content_of_folder(disk_ / "sample");
  }

  Outcome rebuild_on(const Fault& fault) const {
    reset_disk();
    return run_on(fault, rebuild_);
  }

  Command rebuild_{BIOTOMY_TOOL, "rebuild", disk_ / "sample"};
  FolderContent old_;
  FolderContent new_;
  std::map<std::string, std::int64_t> calls_;  ///< when none fails
};

TEST_F(RebuildOnAFaultyDisk, LeavesTheVolumeThatWasThere) {
  fail_in_turn(rebuild_);
  fill_the_disk(rebuild_);
}

// After the last rename, of which it is the place that counts: threads that make the same folders
// sync some of them twice, or not.
TEST_F(RebuildOnAFaultyDisk, TakesBackANewVolumeThatIsNotKnownToLast) {
  expect_clear_failure(rebuild_on({.folder = disk_,
                                   .call = "sync",
                                   .at = 1,
                                   .times = 1,
                                   .after_renames = calls_.at("rename"),
                                   .error = "EIO"}));
  EXPECT_EQ(counted_calls().at("rename"), calls_.at("rename") + 1) << "there and back";
  EXPECT_TRUE(content_of_folder(disk_ / "sample") == old_);
}

TEST_F(RebuildOnAFaultyDisk, RenamesTwiceWhereTwoFoldersCannotChangePlaces) {
  const Outcome outcome = rebuild_on({.folder = disk_, .cannot_exchange = true});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(counted_calls().at("rename"), calls_.at("rename") + 1);
  EXPECT_TRUE(content_of_folder(disk_ / "sample") == new_);
}

TEST_F(RebuildOnAFaultyDisk, TakesBackANewVolumeAlsoWhereTwoFoldersCannotChangePlaces) {
  expect_clear_failure(rebuild_on({.folder = disk_,
                                   .call = "sync",
                                   .at = 1,
                                   .times = 1,
                                   .after_renames = calls_.at("rename") + 1,
                                   .error = "EIO",
                                   .cannot_exchange = true}));
  EXPECT_TRUE(content_of_folder(disk_ / "sample") == old_);
}

// Both the rename to its new name and the one back.
TEST_F(RebuildOnAFaultyDisk, SaysWhereTheOldVolumeIsWhenItCannotBePutBack) {
  const Outcome outcome = rebuild_on({.folder = disk_,
                                      .call = "rename",
                                      .at = calls_.at("rename") + 1,
                                      .error = "EIO",
                                      .cannot_exchange = true});
  expect_clear_failure(outcome);
  EXPECT_NE(outcome.errors.find(".volume.ome.zarr.partial.old"), std::string::npos)
      << outcome.errors;
  EXPECT_EQ(run(rebuild_, folder_.path()).exit_code, 0);
  EXPECT_TRUE(content_of_folder(disk_ / "sample") == new_);
}

TEST_F(RebuildOnAFaultyDisk, PutsTheOldVolumeBackWhenTheNewOneCannotHaveItsName) {
  const std::int64_t aside = calls_.at("rename");  // the first of the two
  for (const std::int64_t failing : {aside, aside + 1}) {
    SCOPED_TRACE("rename " + std::to_string(failing) + " fails");
    expect_clear_failure(rebuild_on({.folder = disk_,
                                     .call = "rename",
                                     .at = failing,
                                     .times = 1,
                                     .error = "EIO",
                                     .cannot_exchange = true}));
    EXPECT_TRUE(content_of_folder(disk_ / "sample") == old_);
  }
}

}  // namespace
}  // namespace biotomy::tests
