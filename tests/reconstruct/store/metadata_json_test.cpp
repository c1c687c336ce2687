#include "reconstruct/store/metadata_json.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string refusal_of(const std::string& text) {
  return message_of<SampleError>([&] { parse_metadata_json(text); });
}

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') +
         std::string(static_cast<std::size_t>(depth), ']');
}

TEST(MetadataJson, IsTheValueThatStandsThere) {
  EXPECT_EQ(parse_metadata_json(R"( {"a": [1, -2.5, "x", null, true], "b": {"a": 0}} )"),
            json({{"a", {1, -2.5, "x", nullptr, true}}, {"b", {{"a", 0}}}}));
}

TEST(MetadataJson, TellsWhereItStopsBeingJson) {
  EXPECT_THAT(refusal_of(R"({"a": 1,})"), HasSubstr("wrong at byte 9"));
  EXPECT_THAT(refusal_of(""), HasSubstr("not JSON"));
  EXPECT_THAT(refusal_of(R"({"a": NaN})"), HasSubstr("not JSON"));
}

TEST(MetadataJson, QuotesNothingOfWhatItCannotRead) {
  EXPECT_LT(refusal_of("{\"" + std::string(500'000, 'a') + "\n").size(), 100U);
}

TEST(MetadataJson, RefusesDeepNestingBeforeItIsBuilt) {
  EXPECT_EQ(parse_metadata_json(nested(32)).dump(), nested(32));
  EXPECT_THAT(refusal_of(nested(33)), HasSubstr("deeper than 32"));
  EXPECT_THAT(refusal_of(nested(500'000)), HasSubstr("deeper than 32"));
  std::string objects;
  for (int i = 0; i < 1000; ++i) {
    objects += "{\"a\":";
  }
  EXPECT_THAT(refusal_of(objects), HasSubstr("deeper than 32"));
}

TEST(MetadataJson, RefusesAKeyThatStandsTwiceInOneObject) {
  EXPECT_THAT(refusal_of(R"({"shape": 1, "b": {"shape": 2}, "shape": 3})"),
              HasSubstr("'shape' stands twice"));
}

TEST(MetadataJson, RefusesANumberThatNoDoubleHolds) {
  EXPECT_THAT(refusal_of(R"([1e999])"), HasSubstr("number that is too large"));
}

TEST(MetadataJson, RefusesMoreThanAMebibyte) {
  const std::string text = "\"" + std::string((1 << 20) - 2, 'a') + "\"";
  EXPECT_EQ(parse_metadata_json(text).get<std::string>().size(), text.size() - 2);
  EXPECT_THAT(refusal_of(text + " "), HasSubstr("1048577 bytes"));
}

TEST(WholeNumber, IsTakenWithinItsLimits) {
  EXPECT_EQ(whole_number(json(1), "a", 1, 5), 1);
  EXPECT_EQ(whole_number(json(5U), "a", 1, 5), 5);
  EXPECT_EQ(whole_number(json(-3), "a", -3, 5), -3);
}

TEST(WholeNumber, IsNeverCutToFit) {
  for (const json& value :
       {json(0), json(6), json(-1), json(std::numeric_limits<std::uint64_t>::max()),
        json((std::uint64_t{1} << 32) + 2), json(2.0), json("2"), json(true), json(nullptr),
        json::array({2})}) {
    EXPECT_THAT(message_of<SampleError>([&] { whole_number(value, "its depth", 1, 5); }),
                testing::StartsWith("its depth must be a whole number from 1 to 5"))
        << value;
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
