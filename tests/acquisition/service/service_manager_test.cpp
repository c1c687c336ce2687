#include "acquisition/service/service_manager.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/notify_socket.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

TEST(ServiceManager, TellsSystemdHowTheDaemonIs) {
  const TemporaryFolder folder;
  NotifySocket systemd(folder / "notify", microseconds(15000000));
  ServiceManager manager;
  manager.ready();
  manager.status("grinding");
  manager.status("grinding");
  manager.alive();
  manager.stopping();
  manager.extend(milliseconds(10000));
  ASSERT_TRUE(systemd.await("EXTEND_TIMEOUT_USEC", seconds(60)));
  EXPECT_THAT(systemd.messages(), ElementsAre("READY=1", "STATUS=grinding", "WATCHDOG=1",
                                              "STOPPING=1", "EXTEND_TIMEOUT_USEC=10000000"));
}

TEST(ServiceManager, GivesNoSignOfLifeThatNobodyAskedFor) {
  const TemporaryFolder folder;
  NotifySocket systemd(folder / "notify");
  ServiceManager manager;
  manager.alive();
  manager.ready();
  ASSERT_TRUE(systemd.await("READY=1", seconds(60)));
  EXPECT_EQ(systemd.count("WATCHDOG"), 0U);
}

TEST(ServiceManager, DoesNotNeedSystemd) {
  ServiceManager manager;
  manager.ready();
  manager.alive();
}

TEST(StatusLine, TellsStateLayerAndWhatIsWaitedFor) {
  JobStatus status;
  status.state = JobState::grinding;
  status.layer = 41;
  status.layers = 1000;
  status.committed = 40;
  status.waiting_for = "waits for the wheel";
  EXPECT_EQ(status_line(status), "grinding, layer 41 of 1000, 40 stored; waits for the wheel");
}

TEST(StatusLine, IsOneLineWithTheAlarm) {
  JobStatus status;
  status.alarm = Alarm{"the door\nREADY=0", "now"};
  EXPECT_EQ(status_line(status), "faulted, 0 stored; alarm: the door READY=0");
}

}  // namespace
}  // namespace biotomy::tests
