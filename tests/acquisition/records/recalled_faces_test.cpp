#include "acquisition/records/recalled_faces.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "acquisition/quality/face_judgement.hpp"
#include "acquisition/quality/light_judgement.hpp"
#include "acquisition/records/layer_journal.hpp"
#include "tests/acquisition/fake_rig.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

struct Past {
  TemporaryFolder folder;
  reconstruct::SampleFolder sample = reconstruct::SampleFolder::create(
      folder.path() / "knee", {.name = "knee",
                               .cuboid = {.size = {96, 64, 30}, .spacing = {10.0, 10.0, 20.0}},
                               .bits = 8,
                               .notes = "",
                               .created = ""});
  LayerJournal journal{sample.journal_path()};
  std::vector<std::filesystem::path> read;

  void commit(std::int64_t layer, std::optional<double> change, Verdict verdict = Verdict::accepted,
              const std::vector<Metric>& metrics = {}) {
    AttemptRow attempt;
    attempt.layer = layer;
    attempt.attempt = 1;
    attempt.assessment.verdict = verdict;
    attempt.assessment.metrics = metrics;
    if (change) attempt.assessment.metrics.push_back({kFaceChange, *change, 0.01, true});
    journal.commit_layer(attempt, 1, "2026-01-01T00:00:00Z");
  }

  RecalledFaces recall(std::int64_t last) {
    return recall_faces(sample, last, [this](const std::filesystem::path& path) {
      read.push_back(path);
      return ground_face(96, 64, 0.5, 1000.0);
    });
  }
};

/// As a camera's noise is noted with a layer whose focus was searched.
std::vector<Metric> noted_noise(double of_all_bands) {
  std::vector<Metric> metrics;
  for (const char* band : {"curvature", "fine", "middle", "coarse", "face"}) {
    metrics.push_back({"noise_" + std::string(band) + "_dark", of_all_bands, 1.0, true});
    metrics.push_back({"noise_" + std::string(band) + "_light", 0.0, 1.0, true});
  }
  return metrics;
}

TEST(RecalledFaces, KnowTheNoiseThatTheLastSearchedLayerWithoutAFlagNoted) {
  Past past;
  for (std::int64_t layer = 1; layer <= 40; ++layer) {
    const bool flagged = layer == 12;
    past.commit(layer, std::nullopt, flagged ? Verdict::accepted_with_flag : Verdict::accepted,
                layer == 5    ? noted_noise(1e-6)
                : layer == 9  ? noted_noise(2e-6)
                : layer == 12 ? noted_noise(3e-6)
                              : std::vector<Metric>{});
  }
  const RecalledFaces recalled = past.recall(40);
  ASSERT_TRUE(recalled.sharpness.noise());
  EXPECT_DOUBLE_EQ(recalled.sharpness.noise()->bands[DetailBand::fine].dark, 2e-6);
  EXPECT_DOUBLE_EQ(recalled.sharpness.recent().front()->tiles.front().noise[DetailBand::fine],
                   2e-6);
  EXPECT_FALSE(past.recall(4).sharpness.noise());
}

TEST(RecalledFaces, AreNoneBeforeALayerIsCommitted) {
  Past past;
  const RecalledFaces recalled = past.recall(0);
  EXPECT_EQ(recalled.faces.face(), nullptr);
  EXPECT_TRUE(recalled.sharpness.recent().empty());
  EXPECT_TRUE(past.read.empty());
}

TEST(RecalledFaces, AreTheLastLayersImageAndTheChangesInTheJournal) {
  Past past;
  past.commit(1, std::nullopt);
  for (std::int64_t layer = 2; layer <= 5; ++layer) {
    past.commit(layer, 0.1 * static_cast<double>(layer));
  }
  const RecalledFaces recalled = past.recall(5);
  const FaceRecord& faces = recalled.faces;
  EXPECT_EQ(faces.layer(), 5);
  ASSERT_NE(faces.face(), nullptr);
  EXPECT_EQ(past.read, std::vector{past.sample.layer_path(5)});
  EXPECT_DOUBLE_EQ(faces.least_change().value(), 0.2);
  EXPECT_EQ(faces.recent_frames().size(), 1U);
  EXPECT_EQ(recalled.sharpness.recent().size(), 1U);
}

TEST(RecalledFaces, AreAsSharpAsTheLastLayerWithoutAFlag) {
  Past past;
  past.commit(1, std::nullopt);
  past.commit(2, 0.2);
  past.commit(3, 0.2, Verdict::accepted_with_flag);
  const RecalledFaces recalled = past.recall(3);
  EXPECT_EQ(recalled.faces.layer(), 3);
  EXPECT_EQ(past.read, (std::vector{past.sample.layer_path(3), past.sample.layer_path(2)}));
  EXPECT_EQ(recalled.sharpness.recent().size(), 1U);
}

TEST(RecalledFaces, OfLayersThatAllHaveAFlagAreNoMeasureOfSharpness) {
  Past past;
  past.commit(1, std::nullopt, Verdict::accepted_with_flag);
  EXPECT_TRUE(past.recall(1).sharpness.recent().empty());
}

TEST(RecalledFaces, OfLongAgoDoNotCount) {
  Past past;
  past.commit(1, 0.001);
  for (std::int64_t layer = 2; layer <= 20; ++layer) past.commit(layer, 0.2);
  EXPECT_DOUBLE_EQ(past.recall(20).faces.least_change().value(), 0.2);
}

TEST(RecalledFaces, HaveTheLastSurfaceAndTheFirstCastingMaterial) {
  Past past;
  for (std::int64_t layer = 1; layer <= 3; ++layer) {
    std::vector<Metric> metrics;
    for (const char* name : kCastingMetrics) {
      if (layer > 1) metrics.push_back({name, 0.1 * static_cast<double>(layer), 1.0, true});
    }
    past.commit(layer, std::nullopt, Verdict::accepted, metrics);
  }
  const SurfaceRecord surfaces = past.recall(3).surfaces;
  EXPECT_EQ(surfaces.layer(), 3);
  ASSERT_NE(surfaces.surface(), nullptr);
  EXPECT_EQ(surfaces.surface()->thumbnail.size(), cv::Size(12, 8));
  ASSERT_TRUE(surfaces.first_casting());
  EXPECT_DOUBLE_EQ(surfaces.first_casting()->level[2], 0.2);
}

TEST(RecalledFaces, AreThoseUpToALayerAmongMany) {
  Past past;
  for (std::int64_t layer = 1; layer <= 12; ++layer) {
    past.commit(layer, layer <= 4 ? 0.2 : 0.001);
  }
  EXPECT_DOUBLE_EQ(past.recall(4).faces.least_change().value(), 0.2);
}

TEST(RecalledFaces, HaveTheFirstCastingMaterialHoweverDeepItBegins) {
  Past past;
  for (std::int64_t layer = 1; layer <= 24; ++layer) {
    AttemptRow attempt;
    attempt.layer = layer;
    attempt.attempt = 1;
    attempt.assessment.verdict = Verdict::accepted;
    for (const char* name : kCastingMetrics) {
      const double level = 0.01 * static_cast<double>(layer);
      if (layer >= 20) attempt.assessment.metrics.push_back({name, level, 1.0, true});
    }
    past.journal.commit_layer(attempt, 1, "2026-01-01T00:00:00Z");
  }
  EXPECT_DOUBLE_EQ(past.recall(24).surfaces.first_casting().value().level[0], 0.2);
}

}  // namespace
}  // namespace biotomy::tests
