#include "firmware_bridge/wire/register_blocks.hpp"

#include <gmock/gmock.h>

namespace biotomy::bridge {
namespace {

using ::testing::ElementsAre;

std::string entry(const std::string& name, int address, const std::string& type = "u16",
                  const std::string& table = "input", const std::string& access = "r") {
  return name + " = { table = '" + table + "', address = " + std::to_string(address) +
         ", type = '" + type + "', access = '" + access + "' }\n";
}

RegisterMap map_of(const std::string& entries) {
  return RegisterMap::parse(
      "[map]\nname = 'a rig'\nversion = 1\nunit_id = 1\nword_order = 'big'\n[registers]\n" +
          entries,
      "map.toml");
}

TEST(RegisterBlocks, FetchTheWholeStatusOfTheReferenceMapInOneRead) {
  const RegisterMap map = RegisterMap::read_file(BIOTOMY_REGISTER_MAP);
  EXPECT_THAT(plan_reads(map, {"column_maximum", "map_magic", "feed_position"}),
              ElementsAre(RegisterBlock{RegisterTable::input, 0, 46}));
}

TEST(RegisterBlocks, RunOverKnownRegistersButNotOverUnknownOnes) {
  const RegisterMap map =
      map_of(entry("a", 0) + entry("b", 1, "u32") + entry("c", 3) + entry("d", 5));
  EXPECT_THAT(plan_reads(map, {"a", "c", "d"}),
              ElementsAre(RegisterBlock{RegisterTable::input, 0, 4},
                          RegisterBlock{RegisterTable::input, 5, 1}));
}

TEST(RegisterBlocks, EndWithTheLastRegisterWanted) {
  const RegisterMap map = map_of(entry("a", 0) + entry("b", 1) + entry("c", 2));
  EXPECT_THAT(plan_reads(map, {"b"}), ElementsAre(RegisterBlock{RegisterTable::input, 1, 1}));
}

TEST(RegisterBlocks, DoNotRunOverRegistersThatCannotBeRead) {
  const RegisterMap map =
      map_of(entry("a", 0, "u16", "holding", "rw") + entry("b", 1, "u16", "holding", "w") +
             entry("c", 2, "u16", "holding", "rw"));
  EXPECT_THAT(plan_reads(map, {"a", "c"}),
              ElementsAre(RegisterBlock{RegisterTable::holding, 0, 1},
                          RegisterBlock{RegisterTable::holding, 2, 1}));
}

TEST(RegisterBlocks, KeepTheTablesApart) {
  const RegisterMap map = map_of(entry("a", 0) + entry("b", 1, "u16", "holding", "rw"));
  EXPECT_EQ(plan_reads(map, {"a", "b"}).size(), 2U);
}

TEST(RegisterBlocks, NeverAskForMoreThanAReadMayNorSplitAValue) {
  std::string entries;
  std::vector<std::string> names;
  for (int i = 0; i < 100; ++i) {
    names.push_back(std::string("v").append(std::to_string(i)));
    entries += entry(names.back(), 2 * i, "u32");
  }
  EXPECT_THAT(plan_reads(map_of(entries), names),
              ElementsAre(RegisterBlock{RegisterTable::input, 0, 124},
                          RegisterBlock{RegisterTable::input, 124, 76}));
}

TEST(RegisterBlocks, RefuseANameThatTheMapLacks) {
  EXPECT_THROW(plan_reads(map_of(entry("a", 0)), {"z"}), ConfigurationError);
}

}  // namespace
}  // namespace biotomy::bridge
