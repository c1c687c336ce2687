#include "firmware_bridge/wire/checked_table.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "tests/firmware_bridge/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::bridge {
namespace {

using ::testing::ElementsAre;
using testing::thrown_message;

CheckedTable parse(std::string_view text) {
  return CheckedTable::parse(text, "rig.toml");
}

template <class Act>
std::string refusal(Act act) {
  return thrown_message<ConfigurationError>(act);
}

TEST(CheckedTable, GivesWhatTheFileSays) {
  const CheckedTable table =
      parse("[a]\ntext = 'x'\nflag = true\ncount = 3\nlength = 2.5\nwhole = 4\nsize = [1, 2.5]\n")
          .table("a");
  EXPECT_EQ(table.get(TextKey{.name = "text"}), "x");
  EXPECT_TRUE(table.get(FlagKey{.name = "flag"}));
  EXPECT_EQ(table.get(IntegerKey{.name = "count"}), 3);
  EXPECT_EQ(table.get(NumberKey{.name = "length"}), 2.5);
  EXPECT_EQ(table.get(NumberKey{.name = "whole"}), 4.0);
  EXPECT_THAT(table.get(NumbersKey{.name = "size", .count = 2}), ElementsAre(1.0, 2.5));
  EXPECT_NO_THROW(table.refuse_unknown_keys());
}

TEST(CheckedTable, GivesAnArrayOfTexts) {
  const TextsKey key{.name = "command", .fallback = std::vector<std::string>{}};
  EXPECT_THAT(parse("command = ['mail', '', 'anna']").get(key), ElementsAre("mail", "", "anna"));
  EXPECT_TRUE(parse("").get(key).empty());
  EXPECT_EQ(refusal([&] { parse("command = 'mail anna'").get(key); }),
            "rig.toml:1: command: expected an array of texts");
  EXPECT_EQ(refusal([&] { parse("command = ['mail', 1]").get(key); }),
            "rig.toml:1: command: expected an array of texts");
}

TEST(CheckedTable, GivesTheFallbackWhereTheFileIsSilent) {
  const CheckedTable table = parse("").table("a").table("b");
  EXPECT_EQ(table.get(TextKey{.name = "text", .fallback = "y"}), "y");
  EXPECT_FALSE(table.get(FlagKey{.name = "flag", .fallback = false}));
  EXPECT_EQ(table.get(IntegerKey{.name = "count", .fallback = 7}), 7);
  EXPECT_EQ(table.get(NumberKey{.name = "length", .fallback = 0.5}), 0.5);
  EXPECT_FALSE(table.has("text"));
}

TEST(CheckedTable, NamesFileLineAndKeyOfAWrongType) {
  EXPECT_EQ(refusal([] { parse("\n[a]\nx = 'one'\n").table("a").get(IntegerKey{.name = "x"}); }),
            "rig.toml:3: a.x: expected an integer");
  EXPECT_EQ(refusal([] { parse("x = 1.5").get(IntegerKey{.name = "x"}); }),
            "rig.toml:1: x: expected an integer");
  EXPECT_EQ(refusal([] { parse("x = 1").get(TextKey{.name = "x"}); }),
            "rig.toml:1: x: expected a text");
  EXPECT_EQ(refusal([] { parse("x = 1").get(FlagKey{.name = "x"}); }),
            "rig.toml:1: x: expected true or false");
  EXPECT_EQ(refusal([] { parse("x = nan").get(NumberKey{.name = "x"}); }),
            "rig.toml:1: x: expected a number");
  EXPECT_EQ(refusal([] { parse("x = [1, 'a']").get(NumbersKey{.name = "x", .count = 2}); }),
            "rig.toml:1: x: expected an array of 2 numbers");
  EXPECT_EQ(refusal([] { parse("x = 1").table("x"); }), "rig.toml:1: x: expected a table, [x]");
}

TEST(CheckedTable, TellsTheRangeThatAValueMissed) {
  EXPECT_EQ(
      refusal([] {
        parse("x = 101").get(NumberKey{.name = "x", .unit = "mm", .minimum = 0.5, .maximum = 100});
      }),
      "rig.toml:1: x: 101 is out of range; expected a number, 0.5 to 100 (mm)");
  EXPECT_EQ(refusal([] { parse("x = -1").get(IntegerKey{.name = "x", .minimum = 0}); }),
            "rig.toml:1: x: -1 is out of range; expected an integer, at least 0");
}

TEST(CheckedTable, ListsTheChoicesOfAText) {
  EXPECT_EQ(refusal([] {
              parse("x = 'ask'").get(TextKey{.name = "x", .choices = {"pause", "accept"}});
            }),
            "rig.toml:1: x: \"ask\" is not possible; expected \"pause\" or \"accept\"");
}

TEST(CheckedTable, RefusesAnEmptyTextUnlessItMayBe) {
  EXPECT_EQ(refusal([] { parse("x = ''").get(TextKey{.name = "x"}); }),
            "rig.toml:1: x: must not be empty");
  EXPECT_EQ(parse("x = ''").get(TextKey{.name = "x", .may_be_empty = true}), "");
}

TEST(CheckedTable, RefusesAMissingRequiredKey) {
  EXPECT_EQ(refusal([] { parse("[a]\n").table("a").get(NumberKey{.name = "x"}); }),
            "rig.toml:1: a.x: missing; expected a number");
}

TEST(CheckedTable, SuspectsAMisspeltKeyBehindAMissingOne) {
  const auto ask = [](const char* text) {
    return refusal([&] { parse(text).get(IntegerKey{.name = "thickness"}); });
  };
  EXPECT_EQ(ask("thicknes = 3"),
            "rig.toml:1: thickness: missing; expected an integer; is it misspelt as \"thicknes\"?");
  EXPECT_EQ(ask("colour = 3"), "rig.toml:1: thickness: missing; expected an integer");
}

TEST(CheckedTable, PutsTheNearestKnownKeyForwardForAnUnknownOne) {
  const CheckedTable table = parse("[camera]\nexposre_us = 1\n");
  table.table("camera").get(NumberKey{.name = "exposure_us", .fallback = 1});
  EXPECT_EQ(refusal([&] { table.refuse_unknown_keys(); }),
            "rig.toml:2: camera.exposre_us: unknown key; did you mean \"exposure_us\"?");
}

TEST(CheckedTable, RefusesAnUnknownTable) {
  const CheckedTable table = parse("[camra]\n[zzzzzz]\n");
  table.table("camera");
  const std::string message = refusal([&] { table.refuse_unknown_keys(); });
  EXPECT_EQ(message, "rig.toml:1: camra: unknown table; did you mean \"camera\"?");
}

TEST(CheckedTable, AccountsForTablesWhoseNamesAreData) {
  const CheckedTable table = parse("[lines.one]\nn = 1\n[lines.two]\nn = 2\n");
  int sum = 0;
  for (const auto& [name, line] : table.table("lines").named_tables()) {
    sum += static_cast<int>(line.get(IntegerKey{.name = "n"}));
  }
  EXPECT_EQ(sum, 3);
  EXPECT_NO_THROW(table.refuse_unknown_keys());
}

TEST(CheckedTable, TellsWhereTheTomlItselfIsWrong) {
  EXPECT_THAT(refusal([] { parse("a = 1\nb = = 2\n"); }),
              ::testing::StartsWith("rig.toml:2:5: not valid TOML: "));
}

TEST(CheckedTable, TellsThatAFileCannotBeOpenedOrIsAFolder) {
  const tests::TemporaryFolder folder;
  EXPECT_THAT(refusal([&] { CheckedTable::read_file(folder / "none.toml"); }),
              ::testing::HasSubstr("none.toml: cannot be opened"));
  EXPECT_THAT(refusal([&] { CheckedTable::read_file(folder / ""); }),
              ::testing::HasSubstr("is a folder"));
}

TEST(CheckedTable, TakesRelativePathsFromTheFilesFolder) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder / "rig.toml") << "a = 1\n";
  const CheckedTable table = CheckedTable::read_file(folder / "rig.toml");
  EXPECT_EQ(table.resolve("map.toml"), folder / "map.toml");
  EXPECT_EQ(table.resolve("/etc/map.toml"), "/etc/map.toml");
}

TEST(CheckedTable, ListsEveryKeyThatWasAskedForOnce) {
  const CheckedTable table = CheckedTable::for_reference();
  for (int twice = 0; twice < 2; ++twice) {
    table.table("job").get(NumberKey{.name = "thickness",
                                     .unit = "um",
                                     .minimum = 0.1,
                                     .maximum = 1000,
                                     .description = "of a layer"});
    table.get(FlagKey{.name = "quiet", .fallback = true});
  }
  const std::vector<DeclaredKey> keys = table.declared_keys();
  ASSERT_EQ(keys.size(), 2U);
  EXPECT_EQ(keys[0].table, "job");
  EXPECT_EQ(keys[0].name, "thickness");
  EXPECT_EQ(keys[0].default_value, "");
  EXPECT_EQ(keys[0].unit, "um");
  EXPECT_EQ(keys[0].allowed, "0.1 to 1000");
  EXPECT_EQ(keys[0].description, "of a layer");
  EXPECT_EQ(keys[1].table, "");
  EXPECT_EQ(keys[1].default_value, "true");
}

}  // namespace
}  // namespace biotomy::bridge
