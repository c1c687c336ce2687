#include "acquisition/focus/autofocus.hpp"

#include <cmath>
#include <functional>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/focus/fake_face.hpp"

namespace biotomy::acquisition {
namespace {

using testing::HasSubstr;
using tests::FakeFace;

constexpr bridge::AxisLimits kColumn{{0.0}, {10000.0}};

struct Search {
  FocusSettings settings{.step = {50.0}};
  SearchPlan plan{.predicted = {5000.0}, .step = {50.0}, .largest_change = {}};
  bridge::AxisLimits limits = kColumn;
  int frames = 0;
  std::function<void(const Autofocus::Request&)> on_request = [](const auto&) {};

  /// Runs it to its end; the actuator goes where it is told.
  Autofocus run(FakeFace& face) {
    Autofocus focus(settings, plan, limits);
    for (int i = 0; i < 10000; ++i) {
      const auto request = focus.next();
      if (!request) return focus;
      on_request(*request);
      if (request->measure) {
        ++frames;
        focus.measured(face.at(request->position.value));
      } else {
        focus.arrived();
      }
    }
    ADD_FAILURE() << "the search does not end";
    return focus;
  }
};

TEST(Autofocus, FindsThePeakBetweenItsPointsWithOneBracketAndAFrameThatConfirmsIt) {
  FakeFace face{.sharp_at_um = 5037.0};
  Search search;
  const Autofocus focus = search.run(face);
  ASSERT_TRUE(focus.found()) << focus.why_not();
  EXPECT_NEAR(focus.found()->position.value, 5037.0, 0.5);
  EXPECT_EQ(search.frames, 6);
  ASSERT_TRUE(focus.found()->measures);
  EXPECT_NEAR(focus.found()->measures->tiles[0].detail(DetailBand::fine).along_x, face.detail,
              0.01 * face.detail);
}

TEST(Autofocus, MovesTheBracketOnUntilThePeakIsInside) {
  for (const double peak : {4400.0, 4900.0, 5100.0, 5600.0}) {
    FakeFace face{.sharp_at_um = peak};
    Search search;
    const Autofocus focus = search.run(face);
    ASSERT_TRUE(focus.found()) << peak << ": " << focus.why_not();
    EXPECT_NEAR(focus.found()->position.value, peak, 1.0);
    EXPECT_GT(search.frames, 6);
  }
}

TEST(Autofocus, WidensABracketThatIsTooFlatForItsNoise) {
  FakeFace face{.sharp_at_um = 5020.0, .width_um = 400.0, .detail = 1e-5, .noise = 0.01};
  Search search;
  search.settings.step = search.plan.step = {5.0};
  const Autofocus focus = search.run(face);
  ASSERT_TRUE(focus.found()) << focus.why_not();
  EXPECT_NEAR(focus.found()->position.value, 5020.0, 25.0) << "three standard deviations";
  EXPECT_GT(focus.found()->step.value, 100.0) << "the next search begins with a wider bracket";
}

TEST(Autofocus, WidensAShallowBracketThatIsDisturbed) {
  FakeFace face{.sharp_at_um = 5020.0, .width_um = 400.0};
  Search search;
  search.settings.step = search.plan.step = {10.0};
  search.on_request = [&](const Autofocus::Request&) {
    face.detail = 0.01 * (1.0 + 0.01 * face.normal(face.random));  // vibrations
  };
  const Autofocus focus = search.run(face);
  ASSERT_TRUE(focus.found()) << focus.why_not();
  EXPECT_NEAR(focus.found()->position.value, 5020.0, 20.0);
}

TEST(Autofocus, FindsNothingWhereThereIsNoDetail) {
  FakeFace face{.detail = 0.0, .noise = 0.01};
  Search search;
  const Autofocus focus = search.run(face);
  EXPECT_FALSE(focus.found());
  EXPECT_THAT(focus.why_not(), HasSubstr("too little detail"));
}

TEST(Autofocus, FindsNothingInADetailThatDoesNotDependOnThePosition) {
  FakeFace face{.covered_tiles = 96};
  Search search;
  EXPECT_FALSE(search.run(face).found());
}

TEST(Autofocus, DoesNotBelieveAPeakFartherThanTheFocusCanHaveChanged) {
  FakeFace face{.sharp_at_um = 5060.0};
  Search search;
  search.plan.largest_change = bridge::Micrometres{40.0};
  const Autofocus focus = search.run(face);
  EXPECT_FALSE(focus.found());
  EXPECT_THAT(focus.why_not(), HasSubstr("more than 40.0 µm"));
  search.plan.largest_change = bridge::Micrometres{80.0};
  EXPECT_TRUE(search.run(face).found());
}

TEST(Autofocus, NeitherMovesFartherThanItsReachNorTakesMoreFramesThanItMay) {
  for (const double peak : {-20000.0, 3000.0, 8000.0, 20000.0}) {
    FakeFace face{.sharp_at_um = peak, .width_um = 2000.0};
    Search search;
    search.settings.shifts = 3;
    search.settings.reach = {600.0};
    search.on_request = [&](const Autofocus::Request& request) {
      EXPECT_LE(std::abs(request.position.value - 5000.0), 600.0 + search.settings.backlash.value);
    };
    EXPECT_FALSE(search.run(face).found()) << peak;
    EXPECT_LE(search.frames, 4 * 6);
  }
}

TEST(Autofocus, NeverLeavesTheLimits) {
  FakeFace face{.sharp_at_um = 5300.0};
  Search search;
  search.limits = {{4990.0}, {5060.0}};
  search.on_request = [&](const Autofocus::Request& request) {
    EXPECT_GE(request.position, search.limits.minimum);
    EXPECT_LE(request.position, search.limits.maximum);
  };
  EXPECT_FALSE(search.run(face).found());
}

TEST(Autofocus, ApproachesEveryMeasurementFromBelowByTheBacklash) {
  FakeFace face{.sharp_at_um = 4800.0};
  Search search;
  double last = 1e9;
  bool approaches = false;
  search.on_request = [&](const Autofocus::Request& request) {
    if (request.measure) {
      EXPECT_GT(request.position.value, last);
      if (approaches) {
        EXPECT_NEAR(request.position.value - last, 50.0, 1e-6);
      }
    }
    approaches = !request.measure;
    last = request.position.value;
  };
  EXPECT_TRUE(search.run(face).found());
}

TEST(Autofocus, SearchesAnewWhenAFrameAtThePeakIsWorseThanTheBracket) {
  FakeFace face{.sharp_at_um = 5000.0};
  Search search;
  int measured = 0;
  search.on_request = [&](const Autofocus::Request& request) {
    measured += request.measure ? 1 : 0;
    if (measured == 6) face.sharp_at_um = 5120.0;  // something gave way
  };
  const Autofocus focus = search.run(face);
  ASSERT_TRUE(focus.found()) << focus.why_not();
  EXPECT_NEAR(focus.found()->position.value, 5120.0, 1.0);
}

TEST(Autofocus, IsNotLedAstrayByPartsThatAreNotTheFace) {
  FakeFace face{.sharp_at_um = 5030.0, .covered_tiles = 24};
  Search search;
  const Autofocus focus = search.run(face);
  ASSERT_TRUE(focus.found()) << focus.why_not();
  EXPECT_NEAR(focus.found()->position.value, 5030.0, 1.0);
}

}  // namespace
}  // namespace biotomy::acquisition
