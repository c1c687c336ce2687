#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/accepted_layer.hpp"
#include "acquisition/records/layer_journal.hpp"
#include "acquisition/records/recalled_faces.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

using nlohmann::json;
using reconstruct::InvalidRequest;
using testing::HasSubstr;

/// A face with detail of its own for every number.
cv::Mat face(int number) {
  cv::Mat noise(180, 240, CV_32FC3);
  cv::RNG(static_cast<std::uint64_t>(number) + 1).fill(noise, cv::RNG::NORMAL, 0.0, 120.0);
  cv::GaussianBlur(noise, noise, {}, 1.5);
  cv::Mat grain(noise.size(), CV_32FC3);
  cv::RNG(static_cast<std::uint64_t>(number) + 1000).fill(grain, cv::RNG::NORMAL, 110.0, 1.5);
  cv::Mat image;
  cv::add(noise, grain, image, cv::noArray(), CV_8U);
  return image;
}

/// The same face, photographed again: only the grain is another.
cv::Mat once_more(const cv::Mat& image) {
  cv::Mat grain(image.size(), CV_32FC3);
  cv::RNG(5).fill(grain, cv::RNG::NORMAL, 0.0, 1.5);
  cv::Mat again;
  cv::add(image, grain, again, cv::noArray(), CV_8U);
  return again;
}

cv::Mat black() {
  return {180, 240, CV_8UC3, cv::Scalar::all(1)};
}

class QcCommand : public testing::Test {
 protected:
  struct Said {
    std::string output;
    std::string failure;
  };

  QcCommand() { std::filesystem::create_directory(images_); }

  std::string put(const std::string& name, const cv::Mat& image) const {
    const std::string path = images_ + "/" + name;
    reconstruct::save_rgb(path, image);
    return path;
  }

  /// Runs `biotomy qc`; what was asked for wrongly is thrown.
  static Said run(std::vector<std::string> arguments) {
    CLI::App app;
    add_qc_command(app);
    arguments.insert(arguments.begin(), "qc");
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    testing::internal::CaptureStdout();
    Said said;
    try {
      app.parse(arguments);
    } catch (const std::runtime_error& error) {
      said.failure = error.what();
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    said.output = testing::internal::GetCapturedStdout();
    return said;
  }

  tests::TemporaryFolder folder_;
  std::string images_ = (folder_.path() / "images").string();
};

TEST_F(QcCommand, JudgesTheImagesOfAFolderInTheirOrder) {
  for (int i = 1; i <= 10; ++i) put("face" + std::to_string(i) + ".png", face(i));
  put("face3.png", black());
  const Said said = run({images_, "--json"});
  EXPECT_EQ(said.failure, "");
  const json document = json::parse(said.output);
  EXPECT_EQ(document.at("accepted"), 9);
  EXPECT_EQ(document.at("rejected"), 1);
  ASSERT_EQ(document.at("frames").size(), 10U);
  const json& dark = document.at("frames").at(2);
  EXPECT_THAT(dark.at("file").get<std::string>(), HasSubstr("face3.png"));
  EXPECT_EQ(dark.at("verdict"), "rejected");
  EXPECT_EQ(dark.at("slug"), "too-dark");
  EXPECT_EQ(document.at("frames").at(9).at("verdict"), "accepted");
}

TEST_F(QcCommand, TakesNamesOfFilesInAnyEncoding) {
  const std::string good = put("good.png", face(1));
  std::filesystem::rename(good, images_ + "/f\xFCnf.png");  // Latin-1
  reconstruct::write_text(images_ + "/f\xFCnfzig.png", "no picture");
  const json document = json::parse(run({images_, "--json"}).output);
  EXPECT_EQ(document.at("accepted"), 1);
  EXPECT_EQ(document.at("unreadable"), 1);
}

TEST_F(QcCommand, FindsAFaceThatDidNotChange) {
  put("1.png", face(1));
  put("2.png", once_more(face(1)));
  const json document = json::parse(run({images_, "--json"}).output);
  EXPECT_EQ(document.at("frames").at(0).at("verdict"), "accepted");
  EXPECT_EQ(document.at("frames").at(1).at("slug"), "face-unchanged");
}

TEST_F(QcCommand, PrintsEveryMetricWithItsLimit) {
  const Said said = run({put("dark.png", black())});
  EXPECT_THAT(said.output, HasSubstr("dark.png  rejected: the mean brightness is"));
  EXPECT_THAT(said.output, testing::ContainsRegex("brightness_minimum +0.00392. ! +limit +0.05"));
  EXPECT_THAT(said.output, testing::ContainsRegex("brightness_maximum +0.00392. +limit +0.95"));
  EXPECT_THAT(said.output, HasSubstr("1 frame: 0 accepted, 1 rejected"));
}

TEST_F(QcCommand, FailsForARejectedFrameOnlyWhenItIsStrict) {
  const std::string dark = put("dark.png", black());
  EXPECT_EQ(run({dark}).failure, "");
  EXPECT_EQ(run({dark, "--strict"}).failure, "rejected frames: 1");
  EXPECT_EQ(run({put("good.png", face(1)), "--strict"}).failure, "");
}

TEST_F(QcCommand, GoesOnBehindAnImageThatCannotBeRead) {
  put("1.png", face(1));
  reconstruct::truncate_file(put("2.png", face(2)), 0.5);
  put("3.png", face(3));
  const Said said = run({images_, "--json"});
  EXPECT_THAT(said.failure, HasSubstr("images that cannot be read: 1"));
  const json document = json::parse(said.output);
  EXPECT_EQ(document.at("frames").at(1).at("verdict"), "unreadable");
  EXPECT_EQ(document.at("frames").at(2).at("verdict"), "accepted");
  EXPECT_EQ(document.at("unreadable"), 1);
}

TEST_F(QcCommand, TakesTheLimitsOfARigsConfiguration) {
  const std::string image = put("good.png", face(1));
  const std::string rig = (folder_ / "rig.toml").string();
  reconstruct::write_text(
      rig,
      "[job]\nsample = \"s\"\nlayers = 3\nlayer_thickness_um = 20\npixel_um = [10, 10]\n"
      "first_face_um = 0\n[stage]\nendpoint = \"tcp://127.0.0.1:1502\"\n[lines]\nendpoint = "
      "\"unix://s\"\n[camera]\nendpoint = \"unix://s\"\n[focus]\nstart_um = 0\n[quality]\n"
      "minimum_brightness = 0.9\n");
  const json document = json::parse(run({image, "--config", rig, "--json"}).output);
  EXPECT_EQ(document.at("frames").at(0).at("slug"), "too-dark");
}

TEST_F(QcCommand, ShowsASamplesLayersBesideWhatTheJournalSaysOfThem) {
  const reconstruct::SampleDescription description{
      .name = "s", .cuboid = {{240, 180, 4}, {10, 10, 20}}, .bits = 8, .notes = "", .created = ""};
  const auto sample = reconstruct::SampleFolder::create(folder_ / "s", description);
  {
    acquisition::LayerJournal journal(sample.journal_path());
    for (int layer = 1; layer <= 4; ++layer) {
      reconstruct::write_layer_image(sample.layer_path(layer), face(layer), {layer, {10, 10, 20}},
                                     {});
      acquisition::AttemptRow row;
      row.layer = layer;
      row.attempt = 1;
      row.taken_at = "2026-01-02T03:04:05Z";
      if (layer == 3) {
        row.assessment.verdict = acquisition::Verdict::rejected;
        row.assessment.reason = "it was blurred";
        journal.record_attempt(row);
        row.attempt = 2;
      }
      row.assessment.verdict = acquisition::Verdict::accepted;
      row.assessment.reason = "it was good";
      row.assessment.metrics = {{"brightness_minimum", 0.123, 0.05, true}};
      journal.commit_layer(row, 1, "2026-01-02T03:04:05Z");
    }
  }
  const json document =
      json::parse(run({"--sample", sample.path().string(), "--layers", "3..4", "--json"}).output);
  ASSERT_EQ(document.at("frames").size(), 2U);
  const json& third = document.at("frames").at(0);
  EXPECT_EQ(third.at("layer"), 3);
  EXPECT_EQ(third.at("verdict"), "accepted");
  ASSERT_EQ(third.at("journal").size(), 2U);
  EXPECT_EQ(third.at("journal").at(0).at("reason"), "it was blurred");
  // It is compared with the layer before, although that was not asked for.
  const auto& metrics = third.at("metrics");
  EXPECT_TRUE(std::any_of(metrics.begin(), metrics.end(),
                          [](const json& metric) { return metric.at("name") == "face_change"; }));

  const std::string text = run({"--sample", sample.path().string(), "--layers", "3"}).output;
  EXPECT_THAT(text,
              HasSubstr("journal: attempt 1, 2026-01-02T03:04:05Z, rejected: it was blurred"));
  EXPECT_THAT(text, HasSubstr("in the journal     0.123"));
}

/// A face in casting material, under a lamp that fades; what it shows changes ever faster.
cv::Mat face_in_casting(int layer, double blur) {
  cv::Mat image(180, 240, CV_32FC3, cv::Scalar(150.0, 140.0, 125.0));
  const cv::Rect middle(24, 18, 192, 144);
  const double part = (0.15 + 0.003 * layer) * layer;
  cv::Mat older(middle.size(), CV_32FC3);
  cv::Mat newer(middle.size(), CV_32FC3);
  cv::RNG(1).fill(older, cv::RNG::NORMAL, 100.0, 60.0);
  cv::RNG(2).fill(newer, cv::RNG::NORMAL, 100.0, 60.0);
  cv::Mat(std::cos(part) * (older - cv::Scalar::all(100.0)) +
          std::sin(part) * (newer - cv::Scalar::all(100.0)) + cv::Scalar::all(100.0))
      .copyTo(image(middle));
  cv::GaussianBlur(image, image, {}, blur);
  image *= 1.0 - 0.004 * layer;
  cv::Mat grain(image.size(), CV_32FC3);
  cv::RNG(static_cast<std::uint64_t>(layer) + 100).fill(grain, cv::RNG::NORMAL, 0.0, 1.5);
  image += grain;
  image.convertTo(image, CV_8U);
  return image;
}

/// A sample as a daemon leaves it that stored every layer, with a flag those out of focus, and was
/// started again in between.
class QcOfASample : public QcCommand {
 protected:
  static constexpr int kLayers = 40;
  static constexpr int kStartedAgain = 27;
  static bool is_flagged(int layer) { return layer == 20 || layer == 21; }

  QcOfASample() {
    acquisition::LayerJournal journal(sample_.journal_path());
    acquisition::FrameExpectation known;
    known.width = 240;
    known.height = 180;
    known.type = CV_8UC3;
    for (int layer = 1; layer <= kLayers; ++layer) {
      if (layer == 1 || layer == kStartedAgain) {
        acquisition::RecalledFaces recalled =
            acquisition::recall_faces(sample_, layer - 1, reconstruct::read_layer_image);
        known.faces = recalled.faces;
        known.sharpness = recalled.sharpness;
        known.surfaces = recalled.surfaces;
        journal.record_event({.kind = "recovery",
                              .state = "recovering",
                              .layer = 0,
                              .text = "goes on with layer " + std::to_string(layer),
                              .at = "2026-01-02T03:04:05Z"});
      }
      bridge::Frame frame;
      frame.image = face_in_casting(layer, is_flagged(layer) ? 0.88 : 0.8);
      known.layer = layer;
      acquisition::AttemptRow row;
      row.layer = layer;
      row.attempt = 1;
      row.taken_at = "2026-01-02T03:04:05Z";
      row.assessment = acquisition::assess(frame, known, {});
      known.faces.saw(*row.assessment.face);
      acquisition::accept_layer(layer, row.assessment, is_flagged(layer), known);
      row.assessment.verdict = is_flagged(layer) ? acquisition::Verdict::accepted_with_flag
                                                 : acquisition::Verdict::accepted;
      reconstruct::write_layer_image(sample_.layer_path(layer), frame.image, {layer, {10, 10, 20}},
                                     {});
      journal.commit_layer(row, 1, "2026-01-02T03:04:05Z");
    }
  }

  /// Every metric of these layers as the journal has it, and every verdict.
  void expect_as_journalled(const std::string& layers, int first, int last) const {
    const json document = json::parse(
        run({"--sample", sample_.path().string(), "--layers", layers, "--json"}).output);
    ASSERT_EQ(document.at("frames").size(), static_cast<std::size_t>(last - first + 1));
    for (const json& entry : document.at("frames")) {
      const json& then = entry.at("journal").at(0);
      EXPECT_EQ(entry.at("verdict"), then.at("verdict")) << entry.at("layer") << then.at("reason");
      const json& now = entry.at("metrics");
      ASSERT_EQ(now.size(), then.at("metrics").size()) << entry.at("layer");
      for (std::size_t i = 0; i < now.size(); ++i) {
        const json& metric = now.at(i);
        const json& journalled = then.at("metrics").at(i);
        EXPECT_EQ(metric.at("name"), journalled.at("name"));
        for (const char* key : {"value", "limit"}) {
          EXPECT_NEAR(metric.at(key).get<double>(), journalled.at(key).get<double>(), 1e-6)
              << entry.at("layer") << ": " << metric.at("name") << " " << key;
        }
      }
    }
  }

  reconstruct::SampleFolder sample_ = reconstruct::SampleFolder::create(
      folder_ / "s", {.name = "s",
                      .cuboid = {{240, 180, kLayers}, {10, 10, 20}},
                      .bits = 8,
                      .notes = "",
                      .created = ""});
};

TEST_F(QcOfASample, SaysOfEachLayerWhatTheDaemonSaid) {
  expect_as_journalled("1..40", 1, 40);
}

TEST_F(QcOfASample, SaysTheSameOfLayersInItsMiddle) {
  expect_as_journalled("19..26", 19, 26);
  expect_as_journalled("27..29", 27, 29);
  expect_as_journalled("40", 40, 40);
}

TEST_F(QcCommand, NamesTheLayerThatALayerWasComparedWith) {
  const reconstruct::SampleDescription description{
      .name = "s", .cuboid = {{240, 180, 12}, {10, 10, 20}}, .bits = 8, .notes = "", .created = ""};
  const auto sample = reconstruct::SampleFolder::create(folder_ / "s", description);
  for (int layer = 1; layer <= 12; ++layer) {
    reconstruct::write_layer_image(sample.layer_path(layer),
                                   layer == 12 ? once_more(face(11)) : face(layer),
                                   {layer, {10, 10, 20}}, {});
  }
  const std::string path = sample.path().string();
  EXPECT_THAT(run({"--sample", path, "--layers", "12"}).output, HasSubstr("from layer 11's"));

  reconstruct::truncate_file(sample.layer_path(9), 0.5);
  EXPECT_THAT(run({"--sample", path, "--layers", "12"}).output, HasSubstr("from layer 11's"));
}

TEST_F(QcCommand, NamesTheImageOfAFolderThatAnImageWasComparedWith) {
  put("1.png", face(1));
  put("2.png", black());
  put("3.png", face(3));
  put("4.png", once_more(face(3)));
  EXPECT_THAT(run({images_}).output, HasSubstr("from layer 3's"));
}

TEST_F(QcCommand, RefusesLayersThatAreNotThere) {
  const auto sample = reconstruct::sample_with_layers(folder_ / "s", {40, 30, 3}, 8, 3);
  const std::string path = sample.path().string();
  EXPECT_THAT(run({"--sample", path, "--layers", "2..4"}).failure, HasSubstr("layers 1 to 3"));
  for (const char* range : {"0..2", "3..2", "1..", "..2", "x", "1-2"}) {
    EXPECT_THROW(run({"--sample", path, "--layers", range}), InvalidRequest) << range;
  }
}

TEST_F(QcCommand, NamesTheSharpestOfASweep) {
  for (int i = 0; i <= 4; ++i) {
    cv::Mat blurred;
    cv::GaussianBlur(face(1), blurred, {}, 0.3 + std::abs(i - 3));
    put(std::to_string(i) + ".png", blurred);
  }
  const json document = json::parse(run({"--sweep", images_, "--json"}).output);
  EXPECT_EQ(document.at("sharpest"), "3.png");
  EXPECT_EQ(document.at("sharpest_index"), 3);
  EXPECT_NEAR(document.at("peak_index").get<double>(), 3.0, 0.5);
  EXPECT_THAT(run({"--sweep", images_}).output, HasSubstr("sharpest: 3.png"));
}

TEST_F(QcCommand, AsksForOneThingToJudge) {
  EXPECT_THROW(run({}), InvalidRequest);
  EXPECT_THROW(run({put("1.png", face(1)), "--sample", "s"}), InvalidRequest);
  EXPECT_THROW(run({put("1.png", face(1)), "--layers", "1..2"}), InvalidRequest);
  EXPECT_THROW(run({"--sweep", put("1.png", face(1))}), InvalidRequest);
  EXPECT_THROW(run({"--sweep", images_, "--strict"}), InvalidRequest);
  EXPECT_THROW(run({"--sweep", images_, "--config", put("1.png", face(1))}), InvalidRequest);
}

}  // namespace
}  // namespace biotomy::tools
