#include "acquisition/viewer/series_pictures.hpp"

#include <map>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/section/series_frames.hpp"
#include "tests/acquisition/viewer/viewed_sample.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::json;
using reconstruct::same_pixels;
using testing::HasSubstr;

constexpr const char* kFrames = "/api/v1/series/frames";
constexpr const char* kFrame = "/api/v1/series/frame";
const std::map<std::string, std::string> kTurn{
    {"kind", "rotate"}, {"axis", "x"}, {"from", "0"}, {"to", "180"}, {"step", "30"}};

std::map<std::string, std::string> with(std::map<std::string, std::string> query,
                                        const std::string& name, const std::string& value) {
  query[name] = value;
  return query;
}

class SeriesPicturesOfASample : public ViewedSample {
 protected:
  SeriesPicturesOfASample() { add_layers(1, 40); }
};

TEST_F(SeriesPicturesOfASample, NameTheirFrames) {
  const json turn = json_of(ask(kFrames, kTurn));
  EXPECT_EQ(turn.at("unit"), "deg");
  ASSERT_EQ(turn.at("frames").size(), 7U);
  EXPECT_EQ(turn.at("frames").at(3).at("index"), 3);
  EXPECT_EQ(turn.at("frames").at(3).at("value"), 90.0);
  EXPECT_EQ(turn.at("frames").at(3).at("label"), "+090.0 deg");
  EXPECT_EQ(turn.at("frames").at(3).at("cuts"), true);
  EXPECT_EQ(turn.at("frames").at(3).at("plane").at("normal"), json({0.0, -1.0, 0.0}));

  const json move = json_of(ask(
      kFrames,
      {{"kind", "translate"}, {"normal", "0,0,1"}, {"from", "0"}, {"to", "800"}, {"step", "100"}}));
  EXPECT_EQ(move.at("unit"), "um");
  EXPECT_EQ(move.at("frames").back().at("cuts"), false) << "the last layer lies at 780";
}

TEST_F(SeriesPicturesOfASample, HaveTheSectionsOfTheLibrarysSeries) {
  const reconstruct::OpenedSample opened(sample_.path());
  reconstruct::VolumeBricks bricks(opened.volume, 50'000'000, {}, &opened.tail);
  const reconstruct::Cuboid& cuboid = opened.volume.cuboid();
  const reconstruct::Series series = reconstruct::rotation_series(
      {.axis = {1, 0, 0}, .through = {}, .normal = {}, .from = 0, .to = 180, .step = 30},
      reconstruct::BasisKind::layer, cuboid);
  reconstruct::SectionStyle style;
  style.background = reconstruct::kGreyBlue;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    const ApiResponse response = ask(kFrame, with(kTurn, "index", std::to_string(i)));
    ASSERT_EQ(response.status, 200) << response.body;
    const reconstruct::SeriesFrame& frame = series.frames[i];
    EXPECT_TRUE(same_pixels(pixels_of(response),
                            cut_section(bricks, {frame.plane, frame.basis, style}).image))
        << i;
  }
}

TEST_F(SeriesPicturesOfASample, HaveOnePixelSizeWhenTheyAreMadeToFit) {
  double pixel = 0.0;
  int widest = 0;
  for (int i = 0; i < 7; ++i) {
    const ApiResponse response =
        ask(kFrame, with(with(kTurn, "fit", "40x40"), "index", std::to_string(i)));
    ASSERT_EQ(response.status, 200) << response.body;
    const json record = json::parse(response.headers.at("Biotomy-Section"));
    if (i == 0) pixel = record.at("pixel_um");
    EXPECT_EQ(record.at("pixel_um"), pixel);
    EXPECT_THAT(record.at("command_here").get<std::string>(), HasSubstr("--pixel="));
    const cv::Mat image = pixels_of(response);
    widest = std::max({widest, image.cols, image.rows});
  }
  EXPECT_EQ(widest, 40);
}

TEST_F(SeriesPicturesOfASample, SayWhatCannotBe) {
  const auto asked = [&](const char* path, const std::map<std::string, std::string>& query) {
    const ApiResponse response = ask(path, query);
    return std::to_string(response.status) + " " + sentence_of(response);
  };
  EXPECT_THAT(asked(kFrame, kTurn), HasSubstr("400 index must be the number of a frame, 0 to 6"));
  EXPECT_THAT(asked(kFrame, with(kTurn, "index", "7")), HasSubstr("400 index"));
  EXPECT_THAT(asked(kFrames, with(kTurn, "kind", "turn")), HasSubstr("400 kind 'turn'"));
  EXPECT_THAT(asked(kFrames, with(kTurn, "step", "0.001")), HasSubstr("400 "));
  EXPECT_THAT(
      asked(kFrames, with(kTurn, "step", "0.01")),
      HasSubstr(
          "413 the series has 18001 frames, and 10000 are the most that are shown or exported"));
  EXPECT_THAT(asked(kFrames, with(kTurn, "axes", "x")),
              HasSubstr("400 there is no parameter 'axes': did you mean axis?"));
  EXPECT_THAT(asked(kFrame, {{"kind", "translate"},
                             {"normal", "0,0,1"},
                             {"from", "0"},
                             {"to", "800"},
                             {"step", "100"},
                             {"index", "8"}}),
              HasSubstr("422 "));
}

}  // namespace
}  // namespace biotomy::acquisition
