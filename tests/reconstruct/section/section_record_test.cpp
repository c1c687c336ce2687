#include "reconstruct/section/section_record.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/section/picture_affine.hpp"

namespace biotomy::reconstruct {
namespace {

SectionRecord example() {
  const Cuboid cuboid{{41, 31, 21}, {10.0, 10.0, 20.0}};
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 60});
  SectionRecord record{
      "Knie Ä",
      cuboid,
      plane,
      outline_section(cuboid, 8, {plane, section_basis(BasisKind::layer, plane), SectionStyle{}}),
      {51, 41},
      {5, 3},
      {0},
      {{"normal", "0,0,1"}}};
  return record;
}

TEST(SectionRecord, SaysAllThatIsToBeKnown) {
  const nlohmann::ordered_json json = to_json(example());
  EXPECT_EQ(json.at("software"), "Biotomy " BIOTOMY_VERSION);
  EXPECT_EQ(json.at("sample").at("name"), "Knie Ä");
  EXPECT_EQ(json.at("sample").at("size"), (std::vector<int>{41, 31, 21}));
  EXPECT_EQ(json.at("sample").at("spacing_um"), (std::vector<double>{10, 10, 20}));
  EXPECT_EQ(json.at("plane").at("normal"), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(json.at("plane").at("offset_um"), -60.0);
  EXPECT_EQ(json.at("polygon_um").size(), 4U);
  EXPECT_EQ(json.at("polygon_um")[0], (std::vector<double>{0, 0, 60}));
  EXPECT_EQ(json.at("rectangle").at("origin_um"), (std::vector<double>{0, 0, 60}));
  EXPECT_EQ(json.at("rectangle").at("p"), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(json.at("rectangle").at("q"), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(json.at("rectangle").at("width_um"), 400.0);
  EXPECT_EQ(json.at("rectangle").at("height_um"), 300.0);
  EXPECT_EQ(json.at("pixel_um"), 10.0);
  EXPECT_EQ(json.at("picture").at("width"), 51);
  EXPECT_EQ(json.at("picture").at("height"), 41);
  EXPECT_EQ(json.at("levels"), std::vector<int>{0});
  EXPECT_EQ(json.at("parameters").at("normal"), "0,0,1");
}

TEST(SectionRecord, HasTheMatricesOfThePictureWithItsBorder) {
  const SectionRecord record = example();
  const nlohmann::ordered_json json = to_json(record);
  const PictureAffine affine = picture_affine(record.outline.grid, record.plane, 5, 3);
  EXPECT_EQ(json.at("pixel_to_sample").get<decltype(affine.pixel_to_sample)>(),
            affine.pixel_to_sample);
  EXPECT_EQ(json.at("sample_to_pixel").get<decltype(affine.sample_to_pixel)>(),
            affine.sample_to_pixel);
}

TEST(SectionRecord, KeepsItsNumbersToTheBitAsText) {
  SectionRecord record = example();
  record.outline.grid.rectangle.origin = {1.0 / 3.0, 2e5 / 7.0, 1e-17};
  const auto json = nlohmann::json::parse(json_text(to_json(record)));
  EXPECT_EQ(json.at("rectangle").at("origin_um"),
            (std::vector<double>{1.0 / 3.0, 2e5 / 7.0, 1e-17}));
}

TEST(SectionRecord, IsOneLineOfAsciiInAPicture) {
  SectionRecord record = example();
  record.parameters["through"] = "\xFF";  // no UTF-8
  const PictureNotes notes = picture_notes(record);
  EXPECT_EQ(notes.pixel, 10.0);
  EXPECT_EQ(notes.title, "Knie Ä");
  EXPECT_TRUE(std::all_of(notes.description.begin(), notes.description.end(),
                          [](char letter) { return letter >= ' ' && letter <= '~'; }));
  EXPECT_EQ(nlohmann::json::parse(notes.description).at("sample").at("name"), "Knie Ä");
}

}  // namespace
}  // namespace biotomy::reconstruct
