#include "reconstruct/sample/layer_verification.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "reconstruct/disk/sha256.hpp"
#include "tests/reconstruct/findings.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class LayerVerification : public testing::Test {
 protected:
  LayerVerification() {
    for (std::int64_t layer = 1; layer <= 4; ++layer) {
      const auto path = sample_.layer_path(layer);
      records_.push_back({"layers/" + path.filename().string(), sha256_of_file(path)});
    }
  }
  std::vector<std::string> findings(bool all_expected = true) {
    HeardFindings heard(sample_.path());
    files_ = verify_layers(sample_, records_, all_expected, heard.listener(), growth_);
    EXPECT_EQ(heard.done, files_);
    EXPECT_EQ(heard.total, files_);
    return heard.findings;
  }

  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {30, 20, 4}, 8, 4);
  std::vector<LayerHash> records_;
  SampleGrowth growth_;
  std::int64_t files_ = 0;
};

TEST_F(LayerVerification, FindsNothingInASampleThatIsWell) {
  EXPECT_THAT(findings(), IsEmpty());
  EXPECT_EQ(files_, 4);
}

TEST_F(LayerVerification, FindsOneByteThatChanged) {
  flip_byte(sample_.layer_path(3), 100);
  EXPECT_THAT(findings(),
              ElementsAre(AllOf(StartsWith("layers/000003.tif: "), HasSubstr("SHA-256"))));
}

TEST_F(LayerVerification, FindsARecordWithoutItsFile) {
  std::filesystem::remove(sample_.layer_path(4));
  EXPECT_THAT(findings(false),
              ElementsAre(AllOf(StartsWith("layers/000004.tif: "), HasSubstr("record"))));
}

TEST_F(LayerVerification, FindsAFileWithoutARecord) {
  records_.erase(records_.begin() + 1);
  EXPECT_THAT(findings(), ElementsAre("layers/000002.tif: has no record"));
}

TEST_F(LayerVerification, FindsALayerThatIsMissingBetweenOthers) {
  std::filesystem::remove(sample_.layer_path(2));
  records_.erase(records_.begin() + 1);
  EXPECT_THAT(findings(false), ElementsAre("layers/000002.tif: is missing"));
}

TEST_F(LayerVerification, MindsAMissingDeepEndOnlyWhenTheSampleShouldBeComplete) {
  std::filesystem::remove(sample_.layer_path(4));
  records_.pop_back();
  EXPECT_THAT(findings(false), IsEmpty());
  EXPECT_THAT(findings(true), ElementsAre("layers/000004.tif: is missing"));
}

TEST_F(LayerVerification, DecodesFilesWithoutAnyRecordsAndSaysSo) {
  records_.clear();
  EXPECT_THAT(findings(), ElementsAre(HasSubstr("no records")));
  truncate_file(sample_.layer_path(2), 0.5);
  EXPECT_THAT(findings(), ElementsAre(HasSubstr("no records"), StartsWith("layers/000002.tif: ")));
}

TEST_F(LayerVerification, DoesNotWaitForAPipeInALayersPlace) {
  const auto path = sample_.layer_path(2);
  std::filesystem::remove(path);
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const auto no_file = AllOf(StartsWith("layers/000002.tif: "), HasSubstr("not a regular file"));
  EXPECT_THAT(findings(), ElementsAre(no_file));
  records_.clear();  // then it is decoded
  EXPECT_THAT(findings(), ElementsAre(HasSubstr("no records"), no_file));
}

TEST_F(LayerVerification, LooksALayerUpOnceMoreWhileTheSampleGrows) {
  std::vector<LayerHash> committed = records_;
  records_.resize(2);
  growth_.is_seen = [] { return true; };
  growth_.records = [&] { return committed; };
  EXPECT_THAT(findings(), IsEmpty());
  committed[2].sha256 = std::string(64, '0');  // it is compared with the record that it has now
  EXPECT_THAT(findings(),
              ElementsAre(AllOf(StartsWith("layers/000003.tif: "), HasSubstr("SHA-256"))));
}

TEST_F(LayerVerification, LetsTheNewestLayerOfASampleThatGrowsBeWithoutARecord) {
  records_.pop_back();
  growth_.is_seen = [] { return true; };
  growth_.records = [&] { return records_; };
  EXPECT_THAT(findings(), IsEmpty());
  truncate_file(sample_.layer_path(4), 0.5);
  EXPECT_THAT(findings(), ElementsAre(StartsWith("layers/000004.tif: cannot be read")));
  records_.pop_back();
  EXPECT_THAT(findings(),
              testing::UnorderedElementsAre("layers/000003.tif: has no record",
                                            StartsWith("layers/000004.tif: cannot be read")));
}

TEST_F(LayerVerification, FindsNothingInASampleThatIsBegunJustNow) {
  for (std::int64_t layer = 2; layer <= 4; ++layer) {
    std::filesystem::remove(sample_.layer_path(layer));
  }
  records_.clear();
  EXPECT_THAT(findings(false), ElementsAre(HasSubstr("no records")));
  growth_.is_seen = [] { return true; };
  EXPECT_THAT(findings(false), IsEmpty());
  std::filesystem::remove(sample_.layer_path(1));
  EXPECT_THAT(findings(false), IsEmpty());
}

TEST_F(LayerVerification, PassesOverAFileThatWasNeverFinished) {
  write_text(sample_.path() / "layers" / ".000005.tif.1-2", "half");
  EXPECT_THAT(findings(), IsEmpty());
}

}  // namespace
}  // namespace biotomy::reconstruct
