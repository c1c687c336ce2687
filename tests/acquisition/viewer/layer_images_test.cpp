#include "acquisition/viewer/layer_images.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "reconstruct/picture/jpeg_reader.hpp"
#include "reconstruct/picture/jpeg_writer.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "tests/acquisition/viewer/viewed_sample.hpp"

namespace biotomy::acquisition {
namespace {

using reconstruct::same_pixels;
using testing::HasSubstr;

cv::Mat pixels_of(const ApiResponse& response) {
  return reconstruct::decode_jpeg(
      std::as_bytes(std::span(response.body.data(), response.body.size())));
}

/// What is left of a picture in a JPEG of the quality that is sent.
cv::Mat as_sent(const cv::Mat& image) {
  return reconstruct::decode_jpeg(reconstruct::encode_jpeg(image, {}, 90));
}

TEST(AReducedImage, HasTheMeansOfBlocksAndOfPartsAtTheEdges) {
  const cv::Mat image = reconstruct::test_image(11, 6);
  const cv::Mat small = reduced(image, 2);
  ASSERT_EQ(small.size(), cv::Size(3, 2));
  for (int y = 0; y < small.rows; ++y) {
    for (int x = 0; x < small.cols; ++x) {
      const cv::Rect block = cv::Rect(4 * x, 4 * y, 4, 4) & cv::Rect(0, 0, 11, 6);
      const cv::Scalar mean = cv::mean(image(block));
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(small.at<cv::Vec3b>(y, x)[c], mean[c], 1.0) << x << ", " << y;
      }
    }
  }
}

/// Images that are larger than a tile.
class LayerImagesOfASample : public testing::Test {
 protected:
  static constexpr reconstruct::GridSize kSize{1300, 700, 4};

  ApiResponse ask(const std::string& path, std::map<std::string, std::string> query = {},
                  const std::string& known = {}) const {
    return api_.answer({.method = "GET",
                        .path = "/api/v1/layers/" + path,
                        .query = std::move(query),
                        .if_none_match = known});
  }

  cv::Mat layer(std::int64_t number) const {
    return reconstruct::read_layer_image(sample_.layer_path(number));
  }

  tests::TemporaryFolder folder_;
  reconstruct::SampleFolder sample_ =
      reconstruct::sample_with_layers(folder_ / "s", kSize, 8, 2, {10.0, 10.0, 20.0});
  SampleApi api_{sample_.path(), {}};
};

TEST_F(LayerImagesOfASample, ComeWholeAndSmaller) {
  const ApiResponse whole = ask("1/image");
  ASSERT_EQ(whole.status, 200) << whole.body;
  EXPECT_EQ(whole.content_type, "image/jpeg");
  const cv::Mat image = layer(1);
  EXPECT_TRUE(same_pixels(pixels_of(whole), as_sent(image)));

  const cv::Mat small = pixels_of(ask("1/image", {{"width", "130"}}));
  ASSERT_EQ(small.size(), cv::Size(130, 70));
  cv::Mat expected;
  cv::resize(image, expected, small.size(), 0.0, 0.0, cv::INTER_AREA);
  EXPECT_TRUE(same_pixels(small, as_sent(expected)));
}

TEST_F(LayerImagesOfASample, ComeInTilesThatCoverThem) {
  const cv::Mat image = layer(2);
  for (const int shift : {0, 1, 2, 3, 11}) {
    const cv::Mat level = reduced(image, shift);
    for (int y = 0; y * kLayerTile < level.rows; ++y) {
      for (int x = 0; x * kLayerTile < level.cols; ++x) {
        const std::string tile =
            std::to_string(shift) + "/" + std::to_string(x) + "/" + std::to_string(y);
        const ApiResponse response = ask("2/tiles/" + tile);
        ASSERT_EQ(response.status, 200) << response.body;
        const cv::Rect place = cv::Rect(x * kLayerTile, y * kLayerTile, kLayerTile, kLayerTile) &
                               cv::Rect({0, 0}, level.size());
        EXPECT_TRUE(same_pixels(pixels_of(response), as_sent(level(place)))) << tile;
      }
    }
  }
}

TEST_F(LayerImagesOfASample, HaveNoTilesOutside) {
  for (const char* path :
       {"1/tiles/0/3/0", "1/tiles/0/0/2", "1/tiles/1/2/0", "1/tiles/21/0/0",
        "1/tiles/0/1000000/1000000", "1/tiles/-1/0/0", "1/tiles/0/0", "1/tiles/0/0/0/0",
        "1/tiles/a/0/0", "1/tiles/0//0", "3/image", "0/image", "3/tiles/0/0/0", "999999/sharpness",
        "x/image", "1/picture", "1/../1/image"}) {
    EXPECT_EQ(ask(path).status, 404) << path;
  }
  EXPECT_EQ(ask("1/image", {{"width", "0"}}).status, 400);
  EXPECT_EQ(ask("1/image", {{"width", "5000"}}).status, 400);
  EXPECT_EQ(ask("1/image", {{"witdh", "100"}}).status, 400);
}

TEST_F(LayerImagesOfASample, AreNotSentTwiceToWhoHasThem) {
  const ApiResponse first = ask("1/tiles/0/0/0");
  const std::string etag = first.headers.at("ETag");
  EXPECT_EQ(ask("1/tiles/0/0/0", {}, etag).status, 304);
  EXPECT_EQ(ask("1/tiles/0/1/0", {}, etag).status, 200);
  reconstruct::write_layer_image(sample_.layer_path(1),
                                 reconstruct::test_image(1300, 700, CV_8UC3, 9),
                                 {1, {10.0, 10.0, 20.0}}, {});
  const ApiResponse other = ask("1/tiles/0/0/0", {}, etag);
  EXPECT_EQ(other.status, 200);
  EXPECT_NE(other.body, first.body);
}

TEST_F(LayerImagesOfASample, MayBeKeptForEverUnderTheirHash) {
  const std::string sha(64, 'a');
  std::ofstream(sample_.hashes_path()) << sha << "  layers/000001.tif\n";
  EXPECT_THAT(ask("1/image", {{"v", "aaaaaaaa"}}).headers.at("Cache-Control"),
              HasSubstr("immutable"));
  EXPECT_THAT(ask("1/image", {{"v", "bbbbbbbb"}}).headers.at("Cache-Control"),
              Not(HasSubstr("immutable")));
  EXPECT_THAT(ask("1/image").headers.at("Cache-Control"), Not(HasSubstr("immutable")));
}

TEST_F(LayerImagesOfASample, HaveAMapOfSharpnessWithHolesWhereThereIsNothing) {
  cv::Mat image = reconstruct::test_image(1300, 700);
  cv::Mat noise(image.size(), CV_8UC3);
  cv::RNG random(3);
  // Waves of 8 pixels at the left, blurred ones in the middle, nothing at the right.
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double wave = 50.0 * std::sin(2 * M_PI * x / 8.0) * std::sin(2 * M_PI * y / 8.0) +
                          20.0 * std::sin(2 * M_PI * x / 40.0);
      const double value = x < 900 ? 120.0 + wave : 120.0;
      image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(value));
    }
  }
  cv::Mat middle = image(cv::Rect(450, 0, 450, 700));
  cv::GaussianBlur(middle, middle, {}, 2.0);
  random.fill(noise, cv::RNG::NORMAL, 3.0, 1.0);
  image += noise;
  reconstruct::write_layer_image(sample_.layer_path(1), image, {1, {10.0, 10.0, 20.0}}, {});

  const ApiResponse response = ask("1/sharpness");
  ASSERT_EQ(response.status, 200) << response.body;
  const auto map = nlohmann::json::parse(response.body);
  const int columns = map.at("columns");
  const int rows = map.at("rows");
  ASSERT_EQ(map.at("values").size(), static_cast<std::size_t>(columns * rows));
  EXPECT_NEAR(map.at("tile_width").get<double>() * columns, 1300.0, 1e-6);
  EXPECT_NEAR(map.at("tile_height").get<double>() * rows, 700.0, 1e-6);
  const auto value = [&](int column) {
    return map.at("values").at(static_cast<std::size_t>(rows / 2 * columns + column));
  };
  ASSERT_TRUE(value(1).is_number()) << map.dump();
  ASSERT_TRUE(value(columns / 2).is_number());
  EXPECT_GT(value(1), value(columns / 2));
  EXPECT_TRUE(value(columns - 1).is_null());
}

TEST_F(LayerImagesOfASample, SayWhatIsWrongWithADamagedFile) {
  std::filesystem::resize_file(sample_.layer_path(1), 10'000);
  const ApiResponse response = ask("1/tiles/0/0/0");
  EXPECT_EQ(response.status, 422);
  EXPECT_THAT(response.body, HasSubstr("000001.tif"));
}

}  // namespace
}  // namespace biotomy::acquisition
