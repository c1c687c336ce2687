#include "acquisition/focus/focus_map.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "acquisition/focus/face_lean.hpp"
#include "tests/acquisition/focus/fake_face.hpp"

namespace biotomy::acquisition {
namespace {

using tests::FakeFace;

std::vector<BracketFrame> bracket_of(FakeFace& face) {
  std::vector<BracketFrame> bracket;
  for (double position = 4850.0; position <= 5150.0; position += 75.0) {
    bracket.push_back({{position}, face.at(position)});
  }
  return bracket;
}

TEST(FocusMap, IsThePlaneInWhichTheFaceLies) {
  FakeFace face{.sharp_at_um = 5010.0, .across_um = 60.0, .down_um = -35.0};
  const auto map = fit_focus_map(bracket_of(face));
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->middle.value, 5010.0, 0.5);
  EXPECT_NEAR(map->across.value, 60.0, 0.5);
  EXPECT_NEAR(map->down.value, -35.0, 0.5);
  EXPECT_NEAR(map->tilt().value, 95.0, 1.0);
}

TEST(FocusMap, TellsHowFarNoiseMayHaveMovedIt) {
  FakeFace face{.sharp_at_um = 5010.0, .across_um = 60.0, .detail = 1e-5, .noise = 0.003};
  const auto map = fit_focus_map(bracket_of(face));
  ASSERT_TRUE(map);
  EXPECT_GT(map->middle_error.value, 0.05);
  EXPECT_NEAR(map->middle.value, 5010.0, 5.0 * map->middle_error.value);
  EXPECT_NEAR(map->across.value, 60.0, 20.0 * map->middle_error.value);
}

TEST(FocusMap, LeavesOutWhatIsNotTheFace) {
  FakeFace face{.sharp_at_um = 5010.0, .across_um = 60.0};
  std::vector<BracketFrame> bracket = bracket_of(face);
  // Chips on the upper left part stand 120 µm above the face.
  FakeFace chips{.sharp_at_um = 4890.0};
  for (BracketFrame& frame : bracket) {
    FrameMeasures mixed = *frame.measures;
    const auto above = chips.at(frame.position.value);
    for (std::size_t i = 0; i < mixed.tiles.size() / 5; ++i) mixed.tiles[i] = above->tiles[i];
    frame.measures = std::make_shared<const FrameMeasures>(mixed);
  }
  const auto map = fit_focus_map(bracket);
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->middle.value, 5010.0, 1.0);
  EXPECT_NEAR(map->across.value, 60.0, 1.0);
}

TEST(FocusMap, IsNothingWhereTooLittleOfTheFaceShowsDetail) {
  FakeFace face{.detail = 1e-7, .noise = 0.01};
  EXPECT_FALSE(fit_focus_map(bracket_of(face)));
}

TEST(FaceLean, IsTheAngleOfThePlane) {
  FocusMap map;
  map.across = {100.0};
  const FaceLean lean = lean_of(map, {10000.0}, {7500.0});
  EXPECT_NEAR(lean.angle_degrees, 0.573, 0.001);
}

}  // namespace
}  // namespace biotomy::acquisition
