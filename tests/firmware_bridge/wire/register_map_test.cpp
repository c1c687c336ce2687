#include "firmware_bridge/wire/register_map.hpp"

#include <gmock/gmock.h>

#include "tests/firmware_bridge/thrown_message.hpp"

namespace biotomy::bridge {
namespace {

using ::testing::HasSubstr;

const std::string kHead =
    "[map]\nname = 'a rig'\nversion = 3\nunit_id = 9\nword_order = 'little'\n[registers]\n";

RegisterMap parse(const std::string& text) {
  return RegisterMap::parse(text, "map.toml");
}

std::string refusal(const std::string& text) {
  return testing::thrown_message<ConfigurationError>([&] { parse(text); });
}

std::string entry(const std::string& name, int address, const std::string& type = "u16",
                  const std::string& table = "input", const std::string& access = "r") {
  return name + " = { table = '" + table + "', address = " + std::to_string(address) +
         ", type = '" + type + "', access = '" + access + "' }\n";
}

TEST(RegisterMap, ReadsTheReferenceMap) {
  const RegisterMap map = RegisterMap::read_file(BIOTOMY_REGISTER_MAP);
  EXPECT_EQ(map.version(), 2);
  EXPECT_EQ(map.word_order(), WordOrder::big);
  const RegisterEntry& feed = map.at("feed_position");
  EXPECT_EQ(feed.table, RegisterTable::input);
  EXPECT_EQ(feed.address, 14);
  EXPECT_EQ(feed.type, RegisterType::i32);
  EXPECT_EQ(feed.scale, 0.1);
  EXPECT_EQ(feed.unit, "um");
  EXPECT_EQ(map.extent(RegisterTable::input), 46);
  EXPECT_EQ(map.extent(RegisterTable::holding), 9);
}

TEST(RegisterMap, SortsItsEntriesByTableAndAddress) {
  const RegisterMap map =
      parse(kHead + entry("c", 0, "u16", "holding", "rw") + entry("b", 5) + entry("a", 1, "f32"));
  ASSERT_EQ(map.entries().size(), 3U);
  EXPECT_EQ(map.entries()[0].name, "a");
  EXPECT_EQ(map.entries()[1].name, "b");
  EXPECT_EQ(map.entries()[2].name, "c");
  EXPECT_EQ(map.unit_id(), 9);
  EXPECT_EQ(map.word_order(), WordOrder::little);
}

TEST(RegisterMap, LetsAnEntryHaveAWordOrderOfItsOwn) {
  const RegisterMap map = parse(
      kHead + entry("as_the_map", 0, "u32") +
      "other = { table = 'input', address = 2, type = 'u32', access = 'r', word_order = 'big' }\n");
  EXPECT_EQ(map.at("as_the_map").word_order, WordOrder::little);
  EXPECT_EQ(map.at("other").word_order, WordOrder::big);
}

TEST(RegisterMap, RefusesTwoEntriesOnOneRegister) {
  EXPECT_EQ(refusal(kHead + entry("wide", 10, "u32") + entry("late", 11)),
            "map.toml:8: registers.late.address: input register 11 is already part of wide");
}

TEST(RegisterMap, AllowsTheSameAddressInBothTables) {
  EXPECT_NO_THROW(parse(kHead + entry("in", 4) + entry("out", 4, "u16", "holding", "w")));
}

TEST(RegisterMap, RefusesAnUnknownType) {
  EXPECT_THAT(refusal(kHead + entry("a", 0, "u8")),
              HasSubstr("registers.a.type: \"u8\" is not possible; expected \"u16\", \"i16\""));
}

TEST(RegisterMap, RefusesAddressesBeyondTheLast) {
  EXPECT_THAT(refusal(kHead + entry("a", 65536)), HasSubstr("65536 is out of range"));
  EXPECT_THAT(refusal(kHead + entry("a", 65535, "u32")), HasSubstr("none after 65535"));
  EXPECT_NO_THROW(parse(kHead + entry("a", 65534, "u32")));
}

TEST(RegisterMap, RefusesToWriteInputRegisters) {
  EXPECT_THAT(refusal(kHead + entry("a", 0, "u16", "input", "rw")),
              HasSubstr("registers.a.access: an input register can only be read"));
}

TEST(RegisterMap, RefusesAMapWithoutItsHeadOrRegisters) {
  EXPECT_THAT(refusal("[registers]\n" + entry("a", 0)), HasSubstr("map.name: missing"));
  EXPECT_THAT(refusal(kHead), HasSubstr("the map has none"));
}

TEST(RegisterMap, RefusesAMisspeltKey) {
  EXPECT_THAT(refusal(kHead + "a = { tabel = 'input', address = 0, type = 'u16', access = 'r' }"),
              HasSubstr("registers.a.table: missing"));
  EXPECT_THAT(
      refusal(kHead +
              "a = { table = 'input', address = 0, type = 'u16', access = 'r', scael = 0.1 }"),
      HasSubstr("registers.a.scael: unknown key; did you mean \"scale\"?"));
}

TEST(RegisterMap, NamesWhatItLacks) {
  const RegisterMap map = parse(kHead + entry("feed_positon", 0));
  EXPECT_EQ(testing::thrown_message<ConfigurationError>([&] { map.at("feed_position"); }),
            "map.toml: registers.feed_position: missing; the map must say where it is (it has "
            "\"feed_positon\")");
}

}  // namespace
}  // namespace biotomy::bridge
