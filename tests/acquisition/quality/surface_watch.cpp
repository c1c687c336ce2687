#include "tests/acquisition/quality/surface_watch.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "acquisition/quality/clipping_levels.hpp"
#include "acquisition/quality/light_judgement.hpp"
#include "acquisition/quality/surface_judgement.hpp"

namespace biotomy::tests {

using namespace acquisition;

Assessment SurfaceWatch::judge(const cv::Mat& image) const {
  Judgement judgement;
  Assessment& result = judgement.result();
  result.surface = std::make_shared<const SurfacePrint>(take_surface_print(image));
  result.light = find_light(*result.surface, record);
  judge_surface(image, clipping_levels(image), record, thresholds, judgement);
  judge_light(record, thresholds, judgement);
  return judgement.finish();
}

Assessment SurfaceWatch::accept(const cv::Mat& image) {
  Assessment assessment = judge(image);
  record.accept(++layer, assessment.surface, assessment.light, assessment.arrived);
  return assessment;
}

void SurfaceWatch::accept_layers(int count) {
  for (int i = 0; i < count; ++i) {
    const Assessment assessment = accept(next_face());
    ASSERT_EQ(assessment.verdict, Verdict::accepted) << layer << ": " << assessment.reason;
  }
}

double value_of(const Assessment& assessment, const std::string& metric) {
  const auto found = std::ranges::find(assessment.metrics, metric, &Metric::name);
  if (found == assessment.metrics.end()) throw std::out_of_range(metric + " was not judged");
  return found->value;
}

bool is_judged(const Assessment& assessment, const std::string& metric) {
  return std::ranges::find(assessment.metrics, metric, &Metric::name) != assessment.metrics.end();
}

}  // namespace biotomy::tests
