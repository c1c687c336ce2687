#include "reconstruct/section/parameter_text.hpp"

#include <functional>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const Vector3 kSpacing{3.0, 4.0, 20.0};

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const InvalidRequest& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParameterText, ReadsNumbersAsTheyAreWritten) {
  EXPECT_EQ(parse_number("--pixel", "2.5"), 2.5);
  EXPECT_EQ(parse_number("--pixel", "-1e3"), -1000.0);
  EXPECT_EQ(parse_number("--pixel", "+.5"), 0.5);
  EXPECT_EQ(parse_number("--pixel", " 7 "), 7.0);
}

TEST(ParameterText, RefusesWhatIsNotOneFiniteNumberAndNamesTheOption) {
  for (const char* text : {"", " ", "2.5um", "nan", "inf", "-inf", "1e999", "0x10", "1,5", "--5",
                           "+-5", "1 2", "two"}) {
    const std::string message = refusal([&] { parse_number("--pixel", text); });
    EXPECT_THAT(message, AllOf(HasSubstr("--pixel"), HasSubstr("number"))) << text;
  }
}

TEST(ParameterText, ReadsVectors) {
  EXPECT_EQ(parse_vector("--normal", "1,-2.5,3e2"), (Vector3{1, -2.5, 300}));
  EXPECT_EQ(parse_vector("--normal", " 1 , 2 , 3 "), (Vector3{1, 2, 3}));
}

TEST(ParameterText, RefusesWhatIsNotAVector) {
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,2,", ",1,2", "1;2;3", "1,2,nan"}) {
    EXPECT_THAT(refusal([&] { parse_vector("--normal", text); }), HasSubstr("--normal")) << text;
  }
}

TEST(ParameterText, ReadsColours) {
  EXPECT_EQ(parse_colour("--background", "0,128,255"), (Colour{0, 128, 255}));
  for (const char* text : {"0,0,256", "-1,0,0", "0.5,0,0", "0,0", "red"}) {
    EXPECT_THAT(refusal([&] { parse_colour("--background", text); }), HasSubstr("--background"))
        << text;
  }
}

TEST(ParameterText, ConvertsPositionsAndLengths) {
  const auto voxels = parse_unit("--unit", "voxel");
  EXPECT_EQ(position_in_micrometres({1, 2, 3}, voxels, kSpacing), (Vector3{3, 8, 60}));
  EXPECT_EQ(length_in_micrometres(2.0, voxels, kSpacing), 6.0);
  const auto millimetres = parse_unit("--unit", "mm");
  EXPECT_EQ(position_in_micrometres({1, 2, 3}, millimetres, kSpacing), (Vector3{1000, 2000, 3000}));
  EXPECT_EQ(length_in_micrometres(2.0, millimetres, kSpacing), 2000.0);
  const auto micrometres = parse_unit("--unit", "um");
  EXPECT_EQ(position_in_micrometres({1, 2, 3}, micrometres, kSpacing), (Vector3{1, 2, 3}));
  EXPECT_THAT(refusal([] { parse_unit("--unit", "cm"); }),
              AllOf(HasSubstr("--unit"), HasSubstr("um, mm or voxel")));
}

TEST(ParameterText, MakesAPlaneOfThreePointsInTheUnit) {
  PlaneText text;
  text.points = "0,0,2  5,0,2 0,5,2";
  const Plane plane = parse_plane("--", text, LengthUnit::voxels, kSpacing);
  EXPECT_NEAR(plane.signed_distance({7, 7, 40}), 0.0, 1e-12);
  EXPECT_EQ(plane.normal().x, 0.0);
}

TEST(ParameterText, MakesAPlaneOfANormalAndAPoint) {
  PlaneText text;
  text.normal = "0,0,1";
  text.through = "0,0,2";
  const Plane plane = parse_plane("--", text, LengthUnit::voxels, kSpacing);
  EXPECT_EQ(plane.offset(), -40.0);
}

TEST(ParameterText, MakesTheChoiceOfARectangle) {
  const auto chosen = [](const char* text, LengthUnit unit = LengthUnit::micrometres) {
    return parse_theta("--theta", text, unit, kSpacing);
  };
  EXPECT_EQ(chosen("bounding"), ThetaChoice(theta::Bounding{}));
  EXPECT_EQ(chosen(" inscribed "), ThetaChoice(theta::Inscribed{}));
  EXPECT_EQ(chosen("inscribed-any"), ThetaChoice(theta::InscribedAny{}));
  EXPECT_EQ(chosen("edge:5"), ThetaChoice(theta::InscribedAtEdge{5}));
  EXPECT_EQ(chosen("custom:1,2,3,40,50,-30"),
            ThetaChoice(theta::Custom{{1, 2, 3}, 40.0, 50.0, -30.0}));
}

TEST(ParameterText, MakesACustomRectangleInTheUnit) {
  EXPECT_EQ(parse_theta("theta", "custom:1,2,3,4,5,6", LengthUnit::voxels, kSpacing),
            ThetaChoice(theta::Custom{{3, 8, 60}, 12.0, 15.0, 6.0}));
  EXPECT_EQ(parse_theta("theta", "custom:1,2,3,4,5,6", LengthUnit::millimetres, kSpacing),
            ThetaChoice(theta::Custom{{1000, 2000, 3000}, 4000.0, 5000.0, 6.0}));
}

TEST(ParameterText, RefusesWhatIsNoRectangleAndNamesTheNearestWord) {
  const auto message = [](const std::string& text) {
    return refusal([&] { parse_theta("--theta", text, LengthUnit::micrometres, kSpacing); });
  };
  EXPECT_THAT(message("inscribd"), AllOf(HasSubstr("--theta 'inscribd'"),
                                         HasSubstr("did you mean inscribed? give bounding")));
  EXPECT_THAT(message("costum:1,2,3,4,5,6"), HasSubstr("did you mean custom?"));
  EXPECT_THAT(message("largest"), AllOf(HasSubstr("give bounding"), Not(HasSubstr("did you"))));
  for (const char* text : {"edge", "edge:", "edge:-1", "edge:1.5", "edge:x", "edge:99999999999"}) {
    EXPECT_THAT(message(text), AllOf(HasSubstr(text), HasSubstr("edge:I"))) << text;
  }
  for (const char* text :
       {"custom", "custom:", "custom:1,2,3,4,5", "custom:1,2,3,4,5,6,7", "custom:1,2,3,4,5,nan"}) {
    EXPECT_THAT(message(text), HasSubstr("custom:X,Y,Z,W,H,ANGLE")) << text;
  }
  for (const char* text : {"custom:1,2,3,0,5,6", "custom:1,2,3,4,-5,6"}) {
    EXPECT_THAT(message(text), HasSubstr("above 0")) << text;
  }
  for (const char* text : {"", "bounding:1", "inscribed:", ":3"}) {
    EXPECT_THAT(message(text), HasSubstr("give bounding")) << text;
  }
}

TEST(ParameterText, RefusesPointsThatAreNotThree) {
  for (const char* points : {"", "0,0,0 1,1,1", "0,0,0 1,0,0 0,1,0 1,1,1", "0,0 1,0 0,1"}) {
    PlaneText text;
    text.points = points;
    EXPECT_THAT(refusal([&] { parse_plane("--", text, LengthUnit::micrometres, kSpacing); }),
                HasSubstr("--points"));
  }
}

TEST(ParameterText, RefusesAPlaneAskedForInNoOrTwoWays) {
  PlaneText none;
  PlaneText half;
  half.normal = "0,0,1";
  PlaneText both;
  both.points = "0,0,0 1,0,0 0,1,0";
  both.normal = "0,0,1";
  for (const PlaneText& text : {none, half, both}) {
    EXPECT_THAT(refusal([&] { parse_plane("", text, LengthUnit::micrometres, kSpacing); }),
                AllOf(HasSubstr("points"), HasSubstr("normal"), HasSubstr("through")));
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
