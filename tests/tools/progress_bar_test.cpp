#include "tools/progress_bar.hpp"

#include <sstream>

#include <gmock/gmock.h>

namespace biotomy::tools {
namespace {

using namespace std::chrono_literals;

class Bar : public testing::Test {
 protected:
  ProgressBar::Now clock() {
    return [this] { return now_; };
  }

  std::ostringstream out_;
  ProgressBar::Clock::time_point now_{1000s};
};

TEST_F(Bar, TellsShareRateAndTimeLeft) {
  ProgressBar bar("Importing", "layers", out_, true, clock());
  now_ += 10s;
  bar.update(50, 200);
  EXPECT_EQ(out_.str(),
            "\r\x1b[KImporting [#######.......................] 50/200 layers, 5.0/s, 0:30 left");
}

TEST_F(Bar, DrawsNothingIntoAPipe) {
  ProgressBar bar("Importing", "layers", out_, false, clock());
  now_ += 10s;
  bar.update(50, 200);
  EXPECT_EQ(out_.str(), "");
}

TEST_F(Bar, DrawsNothingForWorkOfLessThanASecond) {
  {
    ProgressBar bar("Importing", "layers", out_, true, clock());
    now_ += 900ms;
    bar.update(199, 200);
  }
  EXPECT_EQ(out_.str(), "");
}

TEST_F(Bar, IsDrawnNoMoreThanTenTimesASecond) {
  ProgressBar bar("Importing", "layers", out_, true, clock());
  now_ += 2s;
  bar.update(1, 200);
  const std::string once = out_.str();
  now_ += 50ms;
  bar.update(2, 200);
  EXPECT_EQ(out_.str(), once);
  now_ += 60ms;
  bar.update(3, 200);
  EXPECT_THAT(out_.str(), testing::HasSubstr("3/200"));
}

TEST_F(Bar, TakesItsLineAwayAtTheEnd) {
  {
    ProgressBar bar("Importing", "layers", out_, true, clock());
    now_ += 2s;
    bar.update(1, 2);
  }
  EXPECT_THAT(out_.str(), testing::EndsWith("left\r\x1b[K"));
}

TEST_F(Bar, TellsHoursWhenItTakesHours) {
  ProgressBar bar("Importing", "layers", out_, true, clock());
  now_ += 100s;
  bar.update(10, 1000);
  EXPECT_THAT(out_.str(), testing::HasSubstr("2:45:00 left"));
}

}  // namespace
}  // namespace biotomy::tools
