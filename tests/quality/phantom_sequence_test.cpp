#include "tests/quality/phantom_sequence.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/quality/labelled_set.hpp"

namespace biotomy::tests {
namespace {

SequenceSettings small() {
  SequenceSettings settings;
  settings.width = 160;
  settings.height = 120;
  settings.layers = 20;
  settings.defects_per_layer = 6;
  return settings;
}

/// All frames of a sequence, the good ones with the layer's defective ones.
std::vector<LabelledLayer> all_layers(const SequenceSettings& settings) {
  PhantomSequence sequence(settings);
  std::vector<LabelledLayer> layers;
  while (std::optional<LabelledLayer> layer = sequence.next()) layers.push_back(std::move(*layer));
  return layers;
}

TEST(PhantomSequence, IsTheSameForTheSameSeedAndAnotherForAnother) {
  SequenceSettings settings = small();
  settings.layers = 7;
  const auto one = all_layers(settings);
  const auto same = all_layers(settings);
  settings.seed = 2;
  const auto other = all_layers(settings);
  ASSERT_EQ(one.size(), 7U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(cv::norm(one[i].good.frame.image, same[i].good.frame.image), 0);
    EXPECT_GT(cv::norm(one[i].good.frame.image, other[i].good.frame.image), 0);
  }
  ASSERT_EQ(one[6].defective.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(one[6].defective[i].strength, same[6].defective[i].strength);
    EXPECT_EQ(cv::norm(one[6].defective[i].frame.image, same[6].defective[i].frame.image), 0);
  }
}

TEST(PhantomSequence, MakesEveryDefectAndDemandsWhatItsStrengthDeserves) {
  std::map<Defect, std::set<Demand>> demands;
  SequenceSettings settings = small();
  for (settings.seed = 1; settings.seed <= 4; ++settings.seed) {
    for (const LabelledLayer& layer : all_layers(settings)) {
      EXPECT_GE(layer.good.contrast, 0.99);
      for (const LabelledFrame& frame : layer.defective) {
        const DefectKind& kind = kind_of(frame.defect);
        demands[frame.defect].insert(frame.demand);
        EXPECT_EQ(frame.demand == Demand::reject, frame.strength >= kind.harmful) << kind.name;
        EXPECT_EQ(frame.demand == Demand::accept, frame.strength <= kind.harmless) << kind.name;
        if (frame.defect == Defect::defocus || frame.defect == Defect::smear) {
          EXPECT_EQ(frame.demand == Demand::reject, frame.contrast <= 0.85) << kind.name;
        }
      }
    }
  }
  for (const DefectKind& kind : defect_kinds()) {
    EXPECT_TRUE(demands[kind.defect].contains(Demand::reject)) << kind.name;
  }
  EXPECT_EQ(demands[Defect::defocus].size(), 3U);
}

TEST(PhantomSequence, ShowsTheDefectThatItNames) {
  std::map<Defect, int> seen;
  cv::Mat before;
  for (const LabelledLayer& layer : all_layers(small())) {
    const cv::Mat& good = layer.good.frame.image;
    const double brightness = cv::sum(cv::mean(good))[0];
    for (const LabelledFrame& frame : layer.defective) {
      const cv::Mat& image = frame.frame.image;
      const double share = 0.01 * frame.strength;
      const double here = cv::sum(cv::mean(image))[0];
      switch (frame.defect) {
        case Defect::lamp_dark:
          EXPECT_NEAR(here / brightness, 1.0 - share, 0.03);
          break;
        case Defect::black:
          EXPECT_EQ(here, 0);
          break;
        case Defect::stale:
          EXPECT_EQ(cv::norm(image, before), 0);
          break;
        case Defect::torn:
          EXPECT_EQ(cv::norm(image.row(image.rows - 1), before.row(image.rows - 1)), 0);
          EXPECT_GT(cv::norm(image.row(0), before.row(0)), 0);
          break;
        case Defect::partial:
          EXPECT_EQ(cv::norm(image.row(image.rows - 1)), 0);
          EXPECT_GT(cv::norm(image.row(0)), 0);
          break;
        case Defect::unchanged:
          // Nothing but noise, a little focus and lamp lies between the two.
          EXPECT_LT(cv::norm(image, before), cv::norm(image, good));
          break;
        default:
          continue;
      }
      ++seen[frame.defect];
    }
    before = good;
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(LabelledSet, HasNoSeedOfTrainingInTheTest) {
  std::set<std::uint64_t> seeds;
  for (const Seeds which : {Seeds::train, Seeds::test}) {
    for (const SequenceSettings& settings : labelled_set(which, 500)) seeds.insert(settings.seed);
  }
  EXPECT_EQ(seeds.size(), 1000U);
}

TEST(LabelledSet, HasLayersOfCastingAloneAndFullOnes) {
  const auto greens = [](const cv::Mat& image) {
    std::vector<cv::Mat> channels;
    cv::split(image, channels);
    return cv::countNonZero(channels[1] > channels[0]) / static_cast<double>(image.total());
  };
  SequenceSettings entering = labelled_set(Seeds::train, 2)[1];
  entering.width = 160;
  entering.height = 120;
  const auto layers = all_layers(entering);
  EXPECT_GT(greens(layers.front().good.frame.image), 0.99);
  EXPECT_LT(greens(layers.back().good.frame.image), 0.6);
}

}  // namespace
}  // namespace biotomy::tests
