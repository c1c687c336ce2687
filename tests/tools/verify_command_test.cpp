#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "acquisition/records/layer_journal.hpp"
#include "acquisition/records/sample_lock.hpp"
#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_hashes.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class VerifyCommand : public testing::Test {
 protected:
  VerifyCommand() { reconstruct::VolumeWriter(sample_, {}).append(3, true); }

  void record_hashes() const {
    std::vector<reconstruct::LayerHash> hashes;
    for (std::int64_t layer = 1; layer <= 3; ++layer) {
      const auto path = sample_.layer_path(layer);
      hashes.push_back({"layers/" + path.filename().string(), reconstruct::sha256_of_file(path)});
    }
    reconstruct::write_text(sample_.hashes_path(), reconstruct::layer_hash_lines(hashes));
  }
  void commit(std::int64_t layer, const std::string& sha256) const {
    acquisition::LayerJournal journal(sample_.journal_path());
    acquisition::AttemptRow row;
    row.layer = layer;
    row.attempt = 1;
    row.assessment.verdict = acquisition::Verdict::accepted;
    row.file = sample_.layer_path(layer).lexically_relative(sample_.path()).string();
    row.sha256 = sha256;
    journal.commit_layer(row, 1, "2026-01-02T03:04:05Z");
  }
  /// What was printed, and the message of the failure, if any.
  std::string run(std::vector<std::string> options = {}) const {
    CLI::App app;
    add_verify_command(app);
    options.insert(options.end(), {sample_.path().string(), "verify"});
    testing::internal::CaptureStdout();
    std::string failure;
    try {
      app.parse(options);  // the last first, as CLI11 wants them
    } catch (const reconstruct::SampleError& error) {
      failure = error.what();
    }
    return testing::internal::GetCapturedStdout() + failure;
  }

  tests::TemporaryFolder folder_;
  reconstruct::SampleFolder sample_ =
      reconstruct::sample_with_layers(folder_ / "s", {20, 10, 3}, 8, 3);
};

TEST_F(VerifyCommand, SaysThatNothingIsWrong) {
  record_hashes();
  EXPECT_EQ(run(), "verified: layer files 3, shards of the volume 1; nothing is wrong\n");
  EXPECT_THAT(run({"--deep"}),
              testing::AllOf(HasSubstr("voxel for voxel"), HasSubstr("nothing is wrong")));
}

TEST_F(VerifyCommand, NamesTheFileThatIsWrongAndFails) {
  record_hashes();
  reconstruct::flip_byte(sample_.layer_path(2), 50);
  const std::string said = run();
  EXPECT_THAT(said, HasSubstr("000002.tif: is not what was stored"));
  EXPECT_THAT(said, HasSubstr("1 thing is wrong"));
}

TEST_F(VerifyCommand, TakesTheRecordsOfAJobFromItsJournal) {
  commit(1, reconstruct::sha256_of_file(sample_.layer_path(1)));
  commit(2, std::string(64, '0'));
  const std::string said = run();
  EXPECT_THAT(said, HasSubstr("000002.tif: is not what was stored"));
  EXPECT_THAT(said, HasSubstr("000003.tif: has no record"));
  EXPECT_THAT(said, HasSubstr("2 things are wrong"));
}

TEST_F(VerifyCommand, LetsTheNewestLayerBeOnItsWayWhileADaemonWorks) {
  for (std::int64_t layer = 1; layer <= 2; ++layer) {
    commit(layer, reconstruct::sha256_of_file(sample_.layer_path(layer)));
  }
  std::filesystem::remove_all(sample_.volume_path());
  const reconstruct::VolumeWriter empty(sample_, {});
  EXPECT_THAT(run(), AllOf(HasSubstr("000003.tif: has no record"), HasSubstr("holds 0 layers"),
                           HasSubstr("2 things are wrong")));
  const acquisition::SampleLock daemon(sample_.path());
  EXPECT_THAT(run({"--deep"}), HasSubstr("nothing is wrong"));
}

TEST_F(VerifyCommand, FindsAJournalThatCannotBeRead) {
  reconstruct::write_text(sample_.journal_path(), "not a database, and long enough to be none");
  EXPECT_THAT(run(), AllOf(HasSubstr(sample_.journal_path().string() + ": "),
                           HasSubstr("2 things are wrong")));  // and there are no records
  const acquisition::SampleLock daemon(sample_.path());
  EXPECT_THAT(run(), HasSubstr("2 things are wrong"));  // each is told once
}

TEST_F(VerifyCommand, NotesWhatARebuildLeftThatWasKilled) {
  record_hashes();
  std::filesystem::create_directory(sample_.path() / ".volume.ome.zarr.partial");
  EXPECT_THAT(run(), AllOf(HasSubstr(".volume.ome.zarr.partial: was left"),
                           HasSubstr("rebuild removes it"), HasSubstr("nothing is wrong")));
  const acquisition::SampleLock rebuild(sample_.path());
  EXPECT_THAT(run(), testing::Not(HasSubstr("partial")));  // it may be the one at work
}

TEST_F(VerifyCommand, NotesTheVolumeThatARebuildLeftAside) {
  record_hashes();
  std::filesystem::rename(sample_.volume_path(), sample_.path() / ".volume.ome.zarr.partial.old");
  EXPECT_THAT(run(), AllOf(HasSubstr(".partial.old: was left"), HasSubstr("rebuild puts it right"),
                           HasSubstr("1 thing is wrong")));
}

}  // namespace
}  // namespace biotomy::tools
