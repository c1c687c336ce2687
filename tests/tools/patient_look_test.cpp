#include "tools/patient_look.hpp"

#include <atomic>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <httplib.h>

namespace biotomy::tools {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

/// A daemon that answers what a test says.
class PatientLookTest : public testing::Test {
 protected:
  PatientLookTest() {
    server_.Get("/api/v1/status", [this](const httplib::Request&, httplib::Response& response) {
      ++asked_;
      response.status = busy_-- > 0 ? 503 : status_.load();
      response.set_content(response.status == 200 ? R"({"state": "done"})" : "{}",
                           "application/json");
    });
    const int port = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::jthread([this] { server_.listen_after_bind(); });
    daemon_ = std::make_unique<DaemonConnection>(
        DaemonOptions{"http://127.0.0.1:" + std::to_string(port), ""});
  }
  ~PatientLookTest() override { server_.stop(); }

  httplib::Server server_;
  std::jthread thread_;
  std::atomic<int> asked_ = 0;
  std::atomic<int> busy_ = 0;
  std::atomic<int> status_ = 200;
  std::unique_ptr<DaemonConnection> daemon_;
};

TEST_F(PatientLookTest, AsksADaemonAgainThatHasNoTime) {
  PatientLook look(*daemon_, {.most = milliseconds(60'000), .pause = milliseconds(1)});
  EXPECT_EQ(look.status().at("state"), "done");
  busy_ = 3;
  testing::internal::CaptureStderr();
  EXPECT_EQ(look.status().at("state"), "done");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "biotomy: HTTP status 503 (it is asked again for 60 s)\n");
  EXPECT_EQ(asked_, 5);
}

TEST_F(PatientLookTest, EndsWhenTheDaemonStaysAway) {
  PatientLook look(*daemon_, {.most = milliseconds(100), .pause = milliseconds(1)});
  look.status();
  server_.stop();
  testing::internal::CaptureStderr();
  EXPECT_THROW(look.status(), DaemonAway);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("is asked again for 1 s)"));
}

TEST_F(PatientLookTest, DoesNotWaitForADaemonThatNeverAnswered) {
  busy_ = 1;
  PatientLook look(*daemon_, {.most = milliseconds(60'000), .pause = milliseconds(1)});
  EXPECT_THROW(look.status(), DaemonAway);
  EXPECT_EQ(asked_, 1);
}

TEST_F(PatientLookTest, DoesNotAskAgainWhatAskingDoesNotMend) {
  PatientLook look(*daemon_, {.most = milliseconds(60'000), .pause = milliseconds(1)});
  look.status();
  status_ = 404;
  EXPECT_THROW(look.status(), std::runtime_error);
  EXPECT_EQ(asked_, 2);
}

TEST_F(PatientLookTest, HasNoPatienceWhenNoneIsAskedFor) {
  PatientLook look(*daemon_, {.most = milliseconds(0), .pause = milliseconds(1)});
  look.status();
  busy_ = 1;
  testing::internal::CaptureStderr();
  EXPECT_THROW(look.status(), DaemonAway);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace biotomy::tools
