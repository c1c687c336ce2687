#include "acquisition/quality/face_record.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;

FaceChange changed_by(double whole, double upper_row, double left_column) {
  return {.whole = Change{whole, 0.0},
          .rows = {Change{upper_row, 0.0}, std::nullopt},
          .columns = {Change{left_column, 0.0}}};
}

TEST(FaceRecord, KnowsTheLayerThatWasAcceptedLast) {
  FaceRecord record;
  EXPECT_EQ(record.face(), nullptr);
  const auto first = std::make_shared<const FacePrint>();
  const auto second = std::make_shared<const FacePrint>();
  record.accept(41, first, {});
  record.accept(42, second, {});
  EXPECT_EQ(record.layer(), 42);
  EXPECT_EQ(record.face(), second.get());
}

TEST(FaceRecord, SaysNothingOfChangesBeforeItKnowsEnough) {
  FaceRecord record;
  record.accept(1, nullptr, changed_by(0.3, 0.2, 0.1));
  record.accept(2, nullptr, changed_by(0.2, 0.1, 0.05));
  EXPECT_FALSE(record.least_change());
  EXPECT_FALSE(record.least_change_of_row(0));
  record.accept(3, nullptr, changed_by(0.4, 0.3, 0.2));
  EXPECT_EQ(record.least_change(), 0.2);
  EXPECT_EQ(record.least_change_of_row(0), 0.1);
  EXPECT_EQ(record.least_change_of_column(0), 0.05);
  EXPECT_FALSE(record.least_change_of_row(1));  // never judged
  EXPECT_FALSE(record.least_change_of_row(7));
}

TEST(FaceRecord, CountsOnlyLayersThatHadContent) {
  FaceRecord record;
  for (int layer = 1; layer <= 10; ++layer) record.accept(layer, nullptr, {});
  EXPECT_FALSE(record.least_change());
}

TEST(FaceRecord, ForgetsWhatIsLongAgo) {
  FaceRecord record;
  record.recall(0.001);
  for (std::size_t i = 0; i < FaceRecord::kRemembered - 1; ++i) record.recall(0.2);
  EXPECT_EQ(record.least_change(), 0.001);
  record.recall(0.3);
  EXPECT_EQ(record.least_change(), 0.2);
}

TEST(FaceRecord, RemembersTheFramesThatWereTakenLast) {
  FaceRecord record;
  for (int i = 0; i < 100; ++i) {
    FacePrint frame;
    frame.frame_rows = std::make_shared<const FrameRows>(FrameRows{{{.hash = 7}}});
    record.saw(frame);
  }
  EXPECT_GE(record.recent_frames().size(), 4U);
  EXPECT_LE(record.recent_frames().size(), 10U);
}

}  // namespace
}  // namespace biotomy::tests
