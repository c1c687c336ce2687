#include "tools/command_parameters.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace biotomy::tools {
namespace {

nlohmann::ordered_json parameters_of(std::vector<std::string> arguments) {
  CLI::App app;
  CLI::App* command = app.add_subcommand("cut", "");
  std::string sample;
  std::string output;
  std::string unit = "um";
  std::string pixel;
  std::vector<int> size;
  bool label = false;
  command->add_option("SAMPLE", sample);
  command->add_option("-o,--output", output);
  command->add_option("--unit", unit)->capture_default_str();
  command->add_option("--pixel", pixel);
  command->add_option("--size", size)->delimiter(',');
  command->add_flag("--label", label);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  app.parse(arguments);
  return command_parameters(*command);
}

TEST(CommandParameters, AreWhatWasTypedAndTheDefaults) {
  EXPECT_EQ(parameters_of({"cut", "knee", "--pixel", "2.50", "-o", "a.png"}),
            (nlohmann::ordered_json{{"command", "cut"}, {"unit", "um"}, {"pixel", "2.50"}}));
}

TEST(CommandParameters, HaveFlagsAndListsThatWereGiven) {
  const auto parameters = parameters_of({"cut", "--label", "--size", "3,4", "--unit", "mm"});
  EXPECT_EQ(parameters.at("label"), "true");
  EXPECT_EQ(parameters.at("size"), "3 4");
  EXPECT_EQ(parameters.at("unit"), "mm");
  EXPECT_FALSE(parameters.contains("pixel"));
}

}  // namespace
}  // namespace biotomy::tools
