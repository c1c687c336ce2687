#include "acquisition/service/metrics/status_metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(StatusMetrics, ShowTheStatusInBaseUnits) {
  JobStatus status;
  status.state = JobState::grinding;
  status.layers = 1000;
  status.committed = 41;
  status.layer = 42;
  status.seconds_left = 3600.0;
  status.disk_left_layers = 2000;
  status.volume.layers_present = 32;
  status.stage = bridge::StageStatus{};
  status.stage->column = {1250.5};
  status.stage->spindle_load_percent = 35.0;
  status.stage->spindle_rpm = 1500.0;
  status.stage->vibration_mm_s = 0.25;
  status.stage->block_temperature_c = -21.5;
  status.last_layer = CommittedLayer{};
  status.last_layer->assessment.sharpness = 0.125;
  status.last_layer->assessment.metrics = {{"brightness", 0.5, 0.05, true}};
  EXPECT_THAT(exposition(status_metrics(status)),
              AllOf(HasSubstr("biotomy_job_state{state=\"grinding\"} 1\n"),
                    HasSubstr("biotomy_job_state{state=\"paused\"} 0\n"),
                    HasSubstr("biotomy_job_layers_committed 41\n"),
                    HasSubstr("biotomy_job_time_left_seconds 3600\n"),
                    HasSubstr("biotomy_disk_left_layers 2000\n"),
                    HasSubstr("biotomy_volume_layers_behind 9\n"),
                    HasSubstr("biotomy_axis_position_meters{axis=\"column\"} 0.0012505\n"),
                    HasSubstr("biotomy_spindle_load_ratio 0.35\n"),
                    HasSubstr("biotomy_spindle_speed_hertz 25\n"),
                    HasSubstr("biotomy_vibration_meters_per_second 0.00025\n"),
                    HasSubstr("biotomy_temperature_celsius{place=\"block\"} -21.5\n"),
                    HasSubstr("biotomy_last_layer_sharpness 0.125\n"),
                    HasSubstr("biotomy_last_layer_quality{metric=\"brightness\"} 0.5\n")));
}

TEST(StatusMetrics, ShowNoValueForWhatIsNotKnown) {
  const std::string text = exposition(status_metrics(JobStatus{}));
  for (const char* name :
       {"biotomy_temperature_celsius", "biotomy_job_time_left_seconds", "biotomy_disk_left_layers",
        "biotomy_last_layer_sharpness", "biotomy_spindle_load_ratio"}) {
    EXPECT_THAT(text, HasSubstr("# TYPE " + std::string(name))) << name;
    EXPECT_THAT(text, Not(HasSubstr("\n" + std::string(name)))) << name;
  }
}

}  // namespace
}  // namespace biotomy::tests
