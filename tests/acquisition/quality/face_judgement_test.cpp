#include "acquisition/quality/face_judgement.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/fake_rig.hpp"
#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// Judges frames as a job does, layer after layer, by the default thresholds.
class Watch {
 public:
  explicit Watch(const PhotographerSettings& settings, double thickness_um = 20.0)
      : photographer(settings), thickness_um_(thickness_um) {
    expectation_.width = settings.width;
    expectation_.height = settings.height;
    expectation_.type = CV_8UC3;
  }

  cv::Mat face(int layer) { return photographer.photograph(layer * thickness_um_); }

  Assessment judge(const cv::Mat& image) {
    bridge::Frame frame;
    frame.image = image;
    frame.sequence = ++sequence_;
    const Assessment assessment = assess(frame, expectation_, thresholds);
    if (assessment.face) expectation_.faces.saw(*assessment.face);
    return assessment;
  }

  Assessment judge_and_accept(int layer, const cv::Mat& image) {
    const Assessment assessment = judge(image);
    expectation_.faces.accept(layer, assessment.face, assessment.face_change);
    expectation_.sharpness.accept(assessment.measures);
    return assessment;
  }

  /// Layers 1 to `last`, each photographed as it is.
  void grind_to(int last) {
    for (int layer = 1; layer <= last; ++layer) {
      const Assessment assessment = judge_and_accept(layer, face(layer));
      ASSERT_EQ(assessment.verdict, Verdict::accepted) << layer << ": " << assessment.reason;
    }
  }

  PhantomPhotographer photographer;
  QualityThresholds thresholds;

 private:
  double thickness_um_;
  FrameExpectation expectation_;
  std::uint64_t sequence_ = 0;
};

/// Bare casting material without any grain.
cv::Mat casting(int exposure) {
  cv::Mat image(320, 320, CV_8UC3, cv::Scalar(60, 120, 80));
  add_noise(image, static_cast<std::uint64_t>(exposure));
  return image;
}

const Metric& metric(const Assessment& assessment, const std::string& name) {
  const auto found = std::ranges::find(assessment.metrics, name, &Metric::name);
  if (found == assessment.metrics.end()) throw std::out_of_range(name + " was not judged");
  return *found;
}

bool has_metric(const Assessment& assessment, const std::string& name) {
  return std::ranges::find(assessment.metrics, name, &Metric::name) != assessment.metrics.end();
}

TEST(FaceJudgement, AcceptsFaceAfterFaceAndSaysHowMuchEachChanged) {
  Watch watch({});
  watch.grind_to(6);
  const Assessment seventh = watch.judge(watch.face(7));
  EXPECT_EQ(seventh.verdict, Verdict::accepted) << seventh.reason;
  EXPECT_TRUE(seventh.shows_the_face);
  const Metric change = metric(seventh, kFaceChange);
  EXPECT_GT(change.value, 2.0 * change.limit);
  EXPECT_GT(change.limit, watch.thresholds.minimum_face_change);  // the record sets it
}

TEST(FaceJudgement, RejectsAFaceFromWhichNothingWasRemoved) {
  for (const double thickness_um : {5.0, 20.0}) {
    for (const int last : {1, 2, 6}) {  // with and without a record of changes
      Watch watch({}, thickness_um);
      watch.grind_to(last);
      const Assessment again = watch.judge(watch.face(last));
      EXPECT_EQ(again.slug, "face-unchanged") << thickness_um << " µm, layer " << last;
      EXPECT_THAT(again.reason, HasSubstr("differs from layer " + std::to_string(last) + "'s"));
      EXPECT_THAT(again.reason, HasSubstr("the grind removed nothing"));
      EXPECT_FALSE(again.shows_the_face);
      EXPECT_FALSE(again.face_changed);
    }
  }
}

TEST(FaceJudgement, RejectsAFaceFromWhichMuchLessThanALayerWasRemoved) {
  Watch watch({});
  watch.grind_to(6);
  EXPECT_EQ(watch.judge(watch.photographer.photograph(6 * 20.0 + 4.0)).slug, "face-unchanged");
}

TEST(FaceJudgement, RejectsAnOldPictureWithANewNumber) {
  Watch watch({});
  watch.grind_to(2);
  const cv::Mat third = watch.face(3);
  watch.judge_and_accept(3, third);
  const Assessment old = watch.judge(third.clone());
  EXPECT_EQ(old.slug, "stale");
  EXPECT_THAT(old.reason, HasSubstr("bit for bit"));
  EXPECT_THAT(old.reason, HasSubstr("the camera gave an old picture again"));
  EXPECT_FALSE(old.shows_the_face);
}

TEST(FaceJudgement, RejectsATornFrameWhoseLowerPartIsOld) {
  for (const int kept : {4, 160, 300}) {
    Watch watch({});
    const cv::Mat first = watch.face(1);
    watch.judge_and_accept(1, first);
    cv::Mat torn = watch.face(2);
    first.rowRange(kept, 320).copyTo(torn.rowRange(kept, 320));
    const Assessment assessment = watch.judge(torn);
    EXPECT_EQ(assessment.slug, "torn") << kept;
    EXPECT_THAT(assessment.reason, HasSubstr("bit for bit"));
    EXPECT_FALSE(assessment.shows_the_face);
  }
}

TEST(FaceJudgement, RejectsAPartThatWasExposedAgainButNotGround) {
  Watch watch({});
  watch.grind_to(5);
  cv::Mat lower = watch.face(6);
  watch.face(5).rowRange(200, 320).copyTo(lower.rowRange(200, 320));
  const Assessment torn = watch.judge(lower);
  EXPECT_EQ(torn.slug, "torn");
  EXPECT_THAT(torn.reason, HasSubstr("the lower 0.250 of the frame still shows layer 5's face"));

  cv::Mat left = watch.face(6);
  watch.face(5).colRange(0, 170).copyTo(left.colRange(0, 170));
  const Assessment part = watch.judge(left);
  EXPECT_EQ(part.slug, "part-unchanged");
  EXPECT_THAT(part.reason, HasSubstr("the left 0.500 of the frame"));
  EXPECT_FALSE(part.shows_the_face);
}

TEST(FaceJudgement, RejectsAFrameThatEndsHalfWay) {
  Watch watch({});
  watch.grind_to(2);
  cv::Mat partial = watch.face(3);
  partial.rowRange(300, 320).setTo(cv::Scalar::all(0));
  const Assessment assessment = watch.judge(partial);
  EXPECT_EQ(assessment.slug, "partial");
  EXPECT_THAT(assessment.reason, HasSubstr("the frame is not complete"));
  EXPECT_FALSE(assessment.shows_the_face);
}

TEST(FaceJudgement, RejectsABlackFrameAsBlack) {
  Watch watch({});
  watch.grind_to(2);
  EXPECT_EQ(watch.judge(cv::Mat(320, 320, CV_8UC3, cv::Scalar::all(0))).slug, "too-dark");
  cv::Mat noise(320, 320, CV_8UC3, cv::Scalar::all(0));
  add_noise(noise, 1);
  EXPECT_EQ(watch.judge(noise).slug, "too-dark");
}

TEST(FaceJudgement, DoesNotTakeARejectedAttemptAtTheSameFaceForTheFaceBefore) {
  Watch watch({});
  watch.grind_to(5);
  watch.judge(watch.photographer.photograph(6 * 20.0, 0.0, 0.0, 400.0));  // blurred
  const Assessment again = watch.judge(watch.face(6));
  EXPECT_EQ(again.verdict, Verdict::accepted) << again.reason;
}

TEST(FaceJudgement, LeavesOpenWhatBareCastingMaterialCannotTell) {
  Watch watch({});
  const Assessment first = watch.judge_and_accept(1, casting(1));
  EXPECT_EQ(first.verdict, Verdict::accepted) << first.reason;
  const Assessment second = watch.judge(casting(2));
  EXPECT_EQ(second.verdict, Verdict::accepted) << second.reason;
  EXPECT_FALSE(has_metric(second, kFaceChange));
  EXPECT_THAT(second.reason, HasSubstr("too little detail to tell the face from layer 1's"));
}

TEST(FaceJudgement, IsSwitchedOffByALimitOfZero) {
  Watch watch({});
  watch.thresholds.minimum_face_change = 0.0;
  watch.grind_to(2);
  EXPECT_EQ(watch.judge(watch.face(2)).verdict, Verdict::accepted);
}

// No false alarm where content changes fast: entering bone, a sample that begins or ends, views
// with hardly any tissue. Views are small, since their few patches vary most: the least margin
// measured there, change to its limit, is 1.5; on larger views it is 2.4.
TEST(FaceJudgement, RaisesNoAlarmWhileTheSpecimenChanges) {
  struct View {
    double left_um;
    double top_um;
    double thickness_um;
  };
  for (const View& view : {View{3000, 2500, 20.0}, View{0, 0, 20.0}, View{400, 4000, 20.0},
                           View{7000, 6500, 20.0}, View{3000, 2500, 5.0}, View{400, 4000, 5.0}}) {
    for (const std::uint64_t seed : {1U, 7U}) {
      Watch watch({.seed = seed,
                   .width = 200,
                   .height = 160,
                   .left_um = view.left_um,
                   .top_um = view.top_um},
                  view.thickness_um);
      watch.thresholds.minimum_sharpness_ratio = 0.0;  // not what is looked at here
      watch.thresholds.minimum_sharpness_along_axis = 0.0;
      watch.grind_to(20);
    }
  }
}

TEST(FaceJudgement, RaisesNoAlarmWhenTissueBeginsOrEndsBetweenTwoLayers) {
  Watch watch({});
  watch.thresholds.minimum_sharpness_ratio = 0.0;
  int layer = 0;
  const auto accepted = [&](const cv::Mat& image) {
    const Assessment assessment = watch.judge_and_accept(++layer, image);
    EXPECT_EQ(assessment.verdict, Verdict::accepted) << layer << ": " << assessment.reason;
  };
  for (int i = 0; i < 4; ++i) accepted(casting(layer));
  for (int i = 0; i < 4; ++i) accepted(watch.face(i));
  for (int i = 0; i < 4; ++i) accepted(casting(layer));
}

struct Moment {
  bridge::Frame frame;
  FrameExpectation expectation;

  std::string slug() const {
    Judgement judgement;
    judge_moment(frame, expectation, judgement);
    EXPECT_EQ(judgement.result().shows_the_face, judgement.result().slug.empty());
    return judgement.result().slug;
  }
};

TEST(FaceJudgement, RejectsAFrameWithTheNumberOfTheOneBefore) {
  Moment moment;
  moment.frame.sequence = 5;
  moment.expectation.previous_sequence = 4;
  EXPECT_EQ(moment.slug(), "");
  moment.expectation.previous_sequence = 5;
  EXPECT_EQ(moment.slug(), "stale");
}

TEST(FaceJudgement, BelievesAFrameThatIsYoungerWhateverItsNumber) {
  Moment moment;
  moment.frame.sequence = 5;
  moment.frame.sensor_timestamp = milliseconds(5000);
  moment.expectation.previous_sequence = 5;
  moment.expectation.previous_timestamp = milliseconds(4000);
  EXPECT_EQ(moment.slug(), "");
  moment.expectation.previous_timestamp = milliseconds(5000);
  EXPECT_EQ(moment.slug(), "stale");
  moment.expectation.previous_timestamp = milliseconds(0);  // it is not known
  EXPECT_EQ(moment.slug(), "stale");
}

TEST(FaceJudgement, RejectsAFrameThatWasExposedBeforeItWasAskedFor) {
  Moment moment;
  moment.frame.sensor_timestamp = milliseconds(5000);
  moment.expectation.asked_at = milliseconds(4999);
  EXPECT_EQ(moment.slug(), "");
  moment.expectation.asked_at = milliseconds(5001);
  EXPECT_EQ(moment.slug(), "stale");
}

TEST(FaceJudgement, RejectsAFrameThatIsNotYoungerThanTheOneBefore) {
  Moment moment;
  moment.frame.sensor_timestamp = milliseconds(5000);
  moment.expectation.previous_timestamp = milliseconds(4000);
  EXPECT_EQ(moment.slug(), "");
  moment.expectation.previous_timestamp = milliseconds(5000);
  EXPECT_EQ(moment.slug(), "stale");
}

TEST(FaceJudgement, BelievesACameraThatTellsNoTime) {
  Moment moment;
  moment.expectation.asked_at = milliseconds(5000);
  moment.expectation.previous_timestamp = milliseconds(4000);
  EXPECT_EQ(moment.slug(), "");
}

}  // namespace
}  // namespace biotomy::tests
