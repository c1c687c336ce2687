#include "acquisition/job/state_diagram.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "acquisition/job/job_states.hpp"

namespace biotomy::acquisition {
namespace {

TEST(StateDiagram, IsThePageInTheDocuments) {
  std::ifstream page(BIOTOMY_STATES_PAGE);
  std::ostringstream text;
  text << page.rdbuf();
  EXPECT_EQ(text.str(), state_diagram()) << "make it anew: biotomyd --state-diagram";
}

TEST(StateDiagram, NamesEveryStateAndEvent) {
  const std::string page = state_diagram();
  for (const JobState state : all_job_states()) {
    EXPECT_NE(page.find(to_string(state)), std::string::npos) << to_string(state);
  }
  for (const JobEvent event : all_job_events()) {
    EXPECT_NE(page.find(to_string(event)), std::string::npos) << to_string(event);
  }
}

}  // namespace
}  // namespace biotomy::acquisition
