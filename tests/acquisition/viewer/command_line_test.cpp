#include "acquisition/viewer/command_line.hpp"

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

TEST(ACommandLine, LeavesOutWhatTheCommandTakesAnyway) {
  EXPECT_EQ(command_line({"biotomy", "section", "/data/knee"},
                         {{"unit", "um", "um"}, {"basis", "xz", "layer"}, {"pixel", ""}}),
            "biotomy section /data/knee --basis=xz");
}

TEST(ACommandLine, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(command_line({"/data/Ann's knee"}, {{"points", "0,0,0 1,0,0 $(id)"}}),
            R"('/data/Ann'\''s knee' --points='0,0,0 1,0,0 $(id)')");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("~"), "'~'");
}

TEST(CommandParametersOfACommandLine, HaveTheDefaultsToo) {
  EXPECT_EQ(command_parameters("section", {{"normal", "0,0,1"}, {"unit", "", "um"}, {"pixel", ""}}),
            (nlohmann::ordered_json{{"command", "section"}, {"normal", "0,0,1"}, {"unit", "um"}}));
}

}  // namespace
}  // namespace biotomy::acquisition
