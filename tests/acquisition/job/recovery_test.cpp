#include "acquisition/job/recovery.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

using testing::HasSubstr;

struct Case {
  JobPlan plan;
  JournalSummary journal;
  bridge::StageStatus controller;

  Case() {
    plan.layers = 10;
    plan.layer_thickness = {20.0};
    plan.first_face = {1000.0};
  }

  /// The journal has `committed` layers, and its last pass was for `layer`.
  void journalled(std::int64_t committed, std::int64_t layer, bool finished) {
    journal.last_committed = committed;
    journal.last_grind = GrindRow{.sequence = 40,
                                  .layer = layer,
                                  .target = plan.face_of(layer),
                                  .ground_before = plan.face_of(layer - 1),
                                  .count_before = layer - 1,
                                  .finished = finished};
  }
  void ground(std::uint32_t count, double to_um) {
    controller.grind_count = count;
    controller.ground_to = {to_um};
  }

  Continuation continuation() const {
    const auto answer = where_to_go_on(plan, journal, controller, {});
    if (const auto* disagreement = std::get_if<Disagreement>(&answer)) {
      ADD_FAILURE() << disagreement->sentence;
      return {};
    }
    return std::get<Continuation>(answer);
  }
  std::string disagreement() const {
    const auto answer = where_to_go_on(plan, journal, controller, {});
    const auto* found = std::get_if<Disagreement>(&answer);
    return found == nullptr ? "" : found->sentence;
  }
};

TEST(Recovery, BeginsAFreshSampleWithLayerOne) {
  Case fresh;
  fresh.ground(0, 500.0);
  EXPECT_EQ(fresh.continuation().layer, 1);
  EXPECT_FALSE(fresh.continuation().ground);
}

TEST(Recovery, RefusesAFreshSampleOnABlockThatIsGroundDeeperAlready) {
  Case fresh;
  fresh.ground(7, 1120.0);
  EXPECT_THAT(fresh.disagreement(), HasSubstr("deeper than layer 1"));
}

TEST(Recovery, GrindsTheNextLayerAfterACommittedOne) {
  Case resumed;
  resumed.journalled(3, 3, true);
  resumed.ground(3, 1040.0);
  EXPECT_EQ(resumed.continuation().layer, 4);
  EXPECT_FALSE(resumed.continuation().ground);
  EXPECT_EQ(resumed.continuation().finished_grind, std::nullopt);
}

TEST(Recovery, PhotographsALayerThatIsGroundButNotCommitted) {
  Case resumed;
  resumed.journalled(3, 4, true);
  resumed.ground(4, 1060.0);
  EXPECT_EQ(resumed.continuation().layer, 4);
  EXPECT_TRUE(resumed.continuation().ground);
}

TEST(Recovery, TellsOfAPassThatEndedUnseen) {
  Case resumed;
  resumed.journalled(3, 4, false);
  resumed.ground(4, 1060.0);
  EXPECT_TRUE(resumed.continuation().ground);
  EXPECT_EQ(resumed.continuation().finished_grind, 40U);
}

TEST(Recovery, GrindsALayerWhosePassWasIntendedButNeverDone) {
  Case resumed;
  resumed.journalled(3, 4, false);
  resumed.ground(3, 1040.0);
  EXPECT_EQ(resumed.continuation().layer, 4);
  EXPECT_FALSE(resumed.continuation().ground);
}

TEST(Recovery, GoesOnBehindTheLastLayerWhenAllAreCommitted) {
  Case finished;
  finished.journalled(10, 10, true);
  finished.ground(10, 1180.0);
  EXPECT_EQ(finished.continuation().layer, 11);
}

TEST(Recovery, StopsWhenPositionAndCounterTellDifferentStories) {
  Case counted;
  counted.journalled(3, 4, false);
  counted.ground(4, 1040.0);  // one pass more, but not deeper
  EXPECT_THAT(counted.disagreement(), HasSubstr("disagrees with the controller"));
  counted.ground(3, 1060.0);  // deeper without a pass
  EXPECT_THAT(counted.disagreement(), HasSubstr("disagrees with the controller"));
  counted.ground(5, 1060.0);  // two passes
  EXPECT_THAT(counted.disagreement(), HasSubstr("counts 2 passes"));
}

TEST(Recovery, StopsWhenAFinishedPassIsGoneFromTheController) {
  Case reset;
  reset.journalled(3, 3, true);
  reset.ground(0, 0.0);
  EXPECT_THAT(reset.disagreement(), HasSubstr("disagrees with the controller"));
}

TEST(Recovery, StopsWhenTheLastPassWasFinishedAndTheControllerKnowsOnlyThoseBefore) {
  Case replaced;
  replaced.journalled(3, 4, true);
  replaced.ground(3, 1040.0);
  EXPECT_THAT(replaced.disagreement(), HasSubstr("disagrees with the controller"));
}

TEST(Recovery, StopsWhenTheControllerDoesNotKnowThePassOfACommittedLayer) {
  Case replaced;
  replaced.journalled(4, 4, false);
  replaced.ground(3, 1040.0);
  EXPECT_THAT(replaced.disagreement(), HasSubstr("disagrees with the controller"));
}

TEST(Recovery, StopsWhenTheGeometryWasChanged) {
  Case changed;
  changed.journalled(3, 3, true);
  changed.ground(3, 1040.0);
  changed.plan.layer_thickness = {50.0};
  EXPECT_THAT(changed.disagreement(), HasSubstr("layer_thickness_um was changed"));
}

TEST(Recovery, StopsWhenTheJournalContradictsItself) {
  Case damaged;
  damaged.journalled(3, 7, true);
  damaged.ground(7, 1120.0);
  EXPECT_THAT(damaged.disagreement(), HasSubstr("damaged"));
}

}  // namespace
}  // namespace biotomy::acquisition
