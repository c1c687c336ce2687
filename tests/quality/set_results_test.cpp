#include "tests/quality/set_results.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/quality/result_tables.hpp"

namespace biotomy::tests {
namespace {

using testing::HasSubstr;

JudgedFrame judged(Defect defect, double strength, Demand demand, const char* slug,
                   double sharpness = 1.0) {
  return {.defect = defect,
          .strength = strength,
          .demand = demand,
          .rejected = std::string(slug) != "good",
          .slug = slug,
          .reason = "because",
          .metrics = {{"sharpness_ratio", sharpness, 0.7, sharpness >= 0.7}}};
}

JudgedFrame good(const char* slug = "good") {
  return judged(Defect::none, 0, Demand::accept, slug);
}

JudgedFrame blurred(double strength, const char* slug, double sharpness) {
  return judged(Defect::defocus, strength, Demand::reject, slug, sharpness);
}

const DefectResult& of(const SetResults& results, Defect defect) {
  return *std::ranges::find_if(
      results.defects, [&](const DefectResult& result) { return result.kind->defect == defect; });
}

TEST(SetResults, CountsEachDefectByWhatWasDemanded) {
  const SetResults results = results_of({good(), good("blurred"), blurred(16, "blurred", 0.6),
                                         blurred(50, "too-dark", 0.5), blurred(50, "good", 0.9),
                                         judged(Defect::defocus, 8, Demand::either, "good"),
                                         judged(Defect::defocus, 2, Demand::accept, "blurred")});
  const DefectResult& defocus = of(results, Defect::defocus);
  EXPECT_EQ(defocus.harmful.frames, 3);
  EXPECT_EQ(defocus.harmful.rejected, 2);
  EXPECT_EQ(defocus.named, 1);
  EXPECT_EQ(defocus.between.frames, 1);
  EXPECT_EQ(defocus.harmless.rejected, 1);
  EXPECT_EQ(defocus.by_strength[0].frames, 1);
  EXPECT_EQ(defocus.by_strength[2].frames, 2);
  EXPECT_EQ(defocus.alarms.rejected, 1);
  EXPECT_EQ(of(results, Defect::frost).alarms.rejected, 0);
  EXPECT_EQ(results.good.frames, 2);
  EXPECT_EQ(results.alarms.at("blurred"), 1);
}

TEST(SetResults, FindsTheMetricThatIsMeantForTheDefectAndWhichSideOfItIsBad) {
  const SetResults results = results_of({good(), blurred(50, "blurred", 0.5)});
  EXPECT_TRUE(of(results, Defect::defocus).has_metric());
  EXPECT_TRUE(of(results, Defect::defocus).values.low_is_bad);
  EXPECT_EQ(area_under_roc(of(results, Defect::defocus).values), 1.0);
  EXPECT_FALSE(of(results, Defect::frost).has_metric());
}

TEST(SetResults, TakesAChangeOfLightByItsAmount) {
  const auto lit = [](Defect defect, Demand demand, double change) {
    JudgedFrame frame = judged(defect, 20, demand, "good");
    frame.metrics = {{"brightness", change, 0.05, std::fabs(change) <= 0.05}};
    return frame;
  };
  const SetResults results =
      results_of({lit(Defect::none, Demand::accept, 0.01), lit(Defect::none, Demand::accept, -0.02),
                  lit(Defect::lamp_dark, Demand::reject, -0.2)});
  EXPECT_EQ(area_under_roc(of(results, Defect::lamp_dark).values), 1.0);
}

TEST(SetResults, MissesItsGoalByOneFrameTooMany) {
  std::vector<JudgedFrame> frames(200, good());
  for (const DefectKind& kind : defect_kinds()) {
    frames.insert(frames.end(), 100, judged(kind.defect, kind.harmful, Demand::reject, "some"));
  }
  EXPECT_TRUE(results_of(frames).reached());

  std::vector<JudgedFrame> alarmed = frames;
  alarmed[0].rejected = true;
  EXPECT_TRUE(results_of(alarmed).reached());
  alarmed[1].rejected = true;
  EXPECT_FALSE(results_of(alarmed).reached());

  for (const auto& [defect, most_missed] : {std::pair{Defect::smear, 1}, {Defect::glare, 2}}) {
    std::vector<JudgedFrame> missed = frames;
    int left = most_missed;
    for (JudgedFrame& frame : missed) {
      if (frame.defect == defect && left-- > 0) frame.rejected = false;
    }
    EXPECT_TRUE(results_of(missed).reached()) << kind_of(defect).name;
    std::ranges::find_if(missed, [defect = defect](const JudgedFrame& frame) {
      return frame.defect == defect && frame.rejected;
    })->rejected = false;
    EXPECT_FALSE(results_of(missed).reached()) << kind_of(defect).name;
  }
}

TEST(ResultTables, ShowWhatWasFoundAndListWhatWasWrong) {
  const std::vector<JudgedFrame> frames{good(), good("blurred"), blurred(50, "blurred", 0.5),
                                        blurred(50, "good", 0.9)};
  const std::string text = markdown(results_of(frames));
  EXPECT_THAT(text, HasSubstr("| defocus | ≥ 15 % of the contrast at half Nyquist | 2 | 50.0 |"));
  EXPECT_THAT(text, HasSubstr("1 of 2 good frames was rejected, 50.00 %"));
  EXPECT_THAT(json(results_of(frames)), HasSubstr("\"rightly_named\": 1"));
  EXPECT_THAT(wrong_answers(frames), HasSubstr("good, contrast 1.000: rejected: because"));
  EXPECT_THAT(wrong_answers(frames), HasSubstr("defocus 50, contrast 1.000: not rejected"));
}

}  // namespace
}  // namespace biotomy::tests
