// The goals of the labelled set, on a part of it. quality_report has the whole.

#include <gtest/gtest.h>

#include "tests/quality/result_tables.hpp"

namespace biotomy::tests {
namespace {

class PartOfTheLabelledSet : public testing::TestWithParam<bool> {};

TEST_P(PartOfTheLabelledSet, HasItsGoodFramesAcceptedAndAtMostAWeakOneOfEachDefectMissed) {
  std::vector<SequenceSettings> set = labelled_set(Seeds::test, 6);
  for (SequenceSettings& settings : set) {
    settings.layers = 12;
    settings.mosaic = GetParam();
  }
  const std::vector<JudgedFrame> frames = judge_set(set, 2);
  const SetResults results = results_of(frames);
  ASSERT_EQ(results.all.frames, 198);
  EXPECT_LE(results.good.rejected, 0) << wrong_answers(frames);
  for (const DefectResult& result : results.defects) {
    EXPECT_GT(result.harmful.frames, 0) << result.kind->name;
    if (result.kind->goal < DefectKind::kUsualGoal) {
      EXPECT_TRUE(result.reached()) << result.kind->name << "\n" << wrong_answers(frames);
      continue;
    }
    // A hundredth of so few frames is none, and the whole set's goals allow for a weak one.
    const Rejections& weak = result.by_strength.front();
    EXPECT_LE(weak.frames - weak.rejected, 1) << result.kind->name << "\n" << wrong_answers(frames);
    EXPECT_EQ(result.harmful.frames - result.harmful.rejected, weak.frames - weak.rejected)
        << result.kind->name << "\n"
        << wrong_answers(frames);
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, PartOfTheLabelledSet, testing::Bool(), [](const auto& mosaic) {
  return mosaic.param ? "WithOneChip" : "WithWhiteNoise";
});

}  // namespace
}  // namespace biotomy::tests
