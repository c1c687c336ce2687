#include "acquisition/viewer/section_task.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/section/section.hpp"
#include "tests/acquisition/viewer/viewed_sample.hpp"

namespace biotomy::acquisition {
namespace {

using reconstruct::Plane;
using reconstruct::same_pixels;
using testing::HasSubstr;

constexpr const char* kSection = "/api/v1/section";
constexpr const char* kOutline = "/api/v1/section/outline";

nlohmann::json record_of(const ApiResponse& response) {
  return nlohmann::json::parse(response.headers.at("Biotomy-Section"));
}

class SectionPicturesOfASample : public ViewedSample {
 protected:
  /// As the library cuts it.
  cv::Mat cut(const Plane& plane, const reconstruct::SectionStyle& style = {}) const {
    const reconstruct::OpenedSample opened(sample_.path());
    reconstruct::VolumeBricks bricks(opened.volume, 50'000'000, {}, &opened.tail);
    return cut_section(bricks, {plane, section_basis(reconstruct::BasisKind::layer, plane), style})
        .image;
  }
};

TEST_F(SectionPicturesOfASample, HaveThePixelsOfTheLibrarysSection) {
  add_layers(1, 40);
  make_volume(40);
  const Plane plane = Plane::through_points({0, 0, 0}, {590, 0, 0}, {0, 539, 780});
  const ApiResponse response =
      ask(kSection, {{"points", "0,0,0 590,0,0 0,539,780"}, {"pixel", "7.5"}});
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.content_type, "image/png");
  reconstruct::SectionStyle style;
  style.pixel = 7.5;
  EXPECT_TRUE(same_pixels(pixels_of(response), cut(plane, style)));
}

TEST_F(SectionPicturesOfASample, ReachTheNewestFaceWhileTheSampleGrows) {
  add_layers(1, 2);
  for (std::int64_t layer = 3; layer <= 36; ++layer) {
    add_layers(layer, layer);
    if (layer == 34) make_volume(34);
    const ApiResponse response = ask(
        kSection, {{"normal", "0,0,1"}, {"through", "0,0," + std::to_string(20 * (layer - 1))}});
    ASSERT_EQ(response.status, 200) << response.body;
    // Voxels are 10 x 11: rows of the picture lie on the layer's only where v * 10 is whole in 11.
    const cv::Mat image = pixels_of(response);
    const cv::Mat face = reconstruct::read_layer_image(sample_.layer_path(layer));
    EXPECT_EQ(image.cols, face.cols);
    EXPECT_TRUE(same_pixels(image.row(0), face.row(0))) << "layer " << layer;
    EXPECT_EQ(record_of(response).at("layers_present"), layer);
  }
}

TEST_F(SectionPicturesOfASample, AreMadeToFitByALargerPixel) {
  add_layers(1, 3);
  const std::map<std::string, std::string> query{{"normal", "0,0,1"}, {"through", "0,0,0"}};
  auto small = query;
  small["fit"] = "24x100";
  const ApiResponse response = ask(kSection, small);
  ASSERT_EQ(response.status, 200) << response.body;
  const auto record = record_of(response);
  EXPECT_EQ(pixels_of(response).cols, 24);
  EXPECT_GT(record.at("pixel_um"), 24.0);
  EXPECT_EQ(record.at("full").at("width"), 60);
  EXPECT_EQ(record.at("full").at("pixel_um"), 10.0);
  EXPECT_THAT(record.at("command").get<std::string>(), Not(HasSubstr("--pixel")));
  EXPECT_THAT(record.at("command_here").get<std::string>(), HasSubstr("--pixel="));

  small["fit"] = "1000x1000";
  EXPECT_EQ(record_of(ask(kSection, small)).at("pixel_um"), 10.0) << "never smaller than asked";
}

TEST_F(SectionPicturesOfASample, FitWhateverTheSizeAndTheUnit) {
  add_layers(1, 3);
  for (const char* unit : {"um", "mm", "voxel"}) {
    for (int side = 1; side <= 70; ++side) {
      const std::string fit = std::to_string(side) + "x" + std::to_string(side);
      const auto picture =
          json_of(ask(kOutline,
                      {{"normal", "0,0,1"}, {"through", "0,0,0"}, {"unit", unit}, {"fit", fit}}))
              .at("picture");
      const int longer = std::max(picture.at("width").get<int>(), picture.at("height").get<int>());
      EXPECT_EQ(longer, std::min(side, 60)) << unit;
    }
  }
}

TEST_F(SectionPicturesOfASample, HaveAnOutlineWithoutPixels) {
  add_layers(1, 3);
  const std::map<std::string, std::string> query{{"points", "0,0,0 590,0,0 0,539,780"}};
  const ApiResponse outline = ask(kOutline, query);
  ASSERT_EQ(outline.status, 200) << outline.body;
  EXPECT_EQ(json_of(outline), record_of(ask(kSection, query)));
}

TEST_F(SectionPicturesOfASample, TellWhatTheySayOfAWrongQuestion) {
  add_layers(1, 3);
  const auto asked = [&](std::map<std::string, std::string> query) {
    const ApiResponse response = ask(kSection, std::move(query));
    return std::to_string(response.status) + " " + sentence_of(response);
  };
  EXPECT_THAT(asked({}), HasSubstr("400 which plane? give either points, or normal and through"));
  EXPECT_THAT(asked({{"points", "0,0,0 1,1,1 2,2,2"}}), HasSubstr("400 "));
  EXPECT_THAT(asked({{"normal", "0,0,1"}, {"trough", "0,0,0"}}),
              HasSubstr("400 there is no parameter 'trough': did you mean through?"));
  EXPECT_THAT(asked({{"normal", "0,0,1"}, {"through", "0,0,-1"}}), HasSubstr("422 "));
  EXPECT_THAT(asked({{"normal", "0,0,1"}, {"through", "0,0,0"}, {"fit", "0x9"}}),
              HasSubstr("400 fit '0x9': give WxH"));
  EXPECT_THAT(asked({{"normal", "0,0,1"}, {"through", "0,0,0"}, {"format", "gif"}}),
              HasSubstr("400 format 'gif'"));
  EXPECT_THAT(asked({{"normal", "0,0,1"}, {"through", "0,0,0"}, {"pixel", "0.01"}}),
              HasSubstr("413 the picture would have 59001 x 53901 pixels"));
}

TEST_F(SectionPicturesOfASample, NeedALayerAndASample) {
  const std::map<std::string, std::string> query{{"normal", "0,0,1"}, {"through", "0,0,0"}};
  EXPECT_EQ(ask(kSection, query).status, 409);
  const SampleApi nowhere(folder_ / "nothing", {});
  const ApiResponse response = nowhere.answer({.method = "GET", .path = kSection, .query = query});
  EXPECT_EQ(response.status, 404);
  EXPECT_THAT(sentence_of(response), HasSubstr("there is no sample yet"));
}

TEST_F(SectionPicturesOfASample, EndWhenNobodyWaits) {
  add_layers(1, 3);
  const ApiResponse response = api_.answer({.method = "GET",
                                            .path = kSection,
                                            .query = {{"normal", "0,0,1"}, {"through", "0,0,0"}},
                                            .client_left = [] { return true; }});
  EXPECT_EQ(response.status, 413) << "not one after which pages ask again";
}

TEST_F(SectionPicturesOfASample, SayWhereAChunkIsDamaged) {
  add_layers(1, 40);
  make_volume(40);
  const std::filesystem::path shard = sample_.volume_path() / "0/c/0/0/0/0";
  ASSERT_TRUE(std::filesystem::exists(shard));
  {
    std::fstream file(shard, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(100);
    file.write("damage", 6);
  }
  const ApiResponse response = ask(kSection, {{"normal", "0,0,1"}, {"through", "0,0,0"}});
  EXPECT_EQ(response.status, 422);
  EXPECT_THAT(sentence_of(response), HasSubstr("damaged"));
}

TEST_F(SectionPicturesOfASample, AreOfASampleThatIsDescribed) {
  const auto empty = json_of(ask("/api/v1/sample"));
  EXPECT_EQ(empty.at("layers_present"), 0);
  EXPECT_EQ(empty.at("size"), nlohmann::json({60, 50, 40}));
  add_layers(1, 3);
  const auto grown = json_of(ask("/api/v1/sample"));
  EXPECT_EQ(grown.at("layers_present"), 3);
  EXPECT_GT(grown.at("generation"), empty.at("generation"));
  EXPECT_EQ(grown.at("generation"), api_.generation());
  EXPECT_EQ(nlohmann::json::parse(api_.sample_event()),
            (nlohmann::json{{"committed", 3},
                            {"layers_present", 3},
                            {"created", grown.at("created")},
                            {"generation", grown.at("generation")}}));
}

}  // namespace
}  // namespace biotomy::acquisition
