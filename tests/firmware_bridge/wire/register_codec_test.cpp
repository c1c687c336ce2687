#include "firmware_bridge/wire/register_codec.hpp"

#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "tests/firmware_bridge/thrown_message.hpp"

namespace biotomy::bridge {
namespace {

RegisterEntry entry(RegisterType type, double scale = 1.0) {
  RegisterEntry entry;
  entry.name = "value";
  entry.type = type;
  entry.scale = scale;
  entry.unit = "um";
  return entry;
}

using Words = std::array<std::uint16_t, 2>;

Words encoded(const RegisterEntry& entry, WordOrder order, double value) {
  Words words = {0x5A5A, 0x5A5A};
  RegisterEntry ordered = entry;
  ordered.word_order = order;
  encode(ordered, value, words);
  return words;
}

TEST(RegisterCodec, LaysOutWordsInTheGivenOrder) {
  EXPECT_EQ(encoded(entry(RegisterType::u32), WordOrder::big, 0x12345678), (Words{0x1234, 0x5678}));
  EXPECT_EQ(encoded(entry(RegisterType::u32), WordOrder::little, 0x12345678),
            (Words{0x5678, 0x1234}));
  EXPECT_EQ(encoded(entry(RegisterType::i32), WordOrder::big, -2), (Words{0xFFFF, 0xFFFE}));
  EXPECT_EQ(encoded(entry(RegisterType::i16), WordOrder::big, -2), (Words{0xFFFE, 0x5A5A}));
  EXPECT_EQ(encoded(entry(RegisterType::f32), WordOrder::big, 1.0), (Words{0x3F80, 0x0000}));
}

TEST(RegisterCodec, GivesBackTheExtremesOfEveryType) {
  const auto check = [](RegisterType type, double value) {
    for (const WordOrder order : {WordOrder::big, WordOrder::little}) {
      RegisterEntry ordered = entry(type);
      ordered.word_order = order;
      EXPECT_EQ(decode(ordered, encoded(entry(type), order, value)), value)
          << to_string(type) << " " << value;
    }
  };
  for (const double value : {0.0, 65535.0}) check(RegisterType::u16, value);
  for (const double value : {-32768.0, 32767.0}) check(RegisterType::i16, value);
  for (const double value : {0.0, 4294967295.0}) check(RegisterType::u32, value);
  for (const double value : {-2147483648.0, 2147483647.0}) check(RegisterType::i32, value);
  for (const double value : {-0.15625, 3.0e38}) {
    check(RegisterType::f32, static_cast<double>(static_cast<float>(value)));
  }
}

TEST(RegisterCodec, ScalesWithoutLeavingADecimalBehind) {
  const RegisterEntry tenths = entry(RegisterType::i32, 0.1);
  for (int raw = -5000; raw <= 5000; ++raw) {
    const double value = raw / 10.0;
    EXPECT_EQ(decode(tenths, encoded(tenths, WordOrder::big, value)), value);
  }
  const RegisterEntry tens = entry(RegisterType::u16, 10);
  EXPECT_EQ(encoded(tens, WordOrder::big, 130)[0], 13);
}

TEST(RegisterCodec, RoundsToTheNearestStep) {
  const RegisterEntry tenths = entry(RegisterType::i16, 0.1);
  EXPECT_EQ(encoded(tenths, WordOrder::big, 1.26)[0], 13);
  EXPECT_EQ(encoded(tenths, WordOrder::big, -1.26)[0], static_cast<std::uint16_t>(-13));
}

TEST(RegisterCodec, RefusesWhatDoesNotFitAndTouchesNothing) {
  const auto refuses = [](RegisterType type, double value) {
    Words words = {0x5A5A, 0x5A5A};
    EXPECT_THROW(encode(entry(type), value, words), RegisterRangeError)
        << to_string(type) << " " << value;
    EXPECT_EQ(words, (Words{0x5A5A, 0x5A5A}));
  };
  for (const double value : {-1.0, 65536.0}) refuses(RegisterType::u16, value);
  for (const double value : {-32769.0, 32768.0}) refuses(RegisterType::i16, value);
  for (const double value : {-1.0, 4294967296.0}) refuses(RegisterType::u32, value);
  for (const double value : {-2147483649.0, 2147483648.0}) refuses(RegisterType::i32, value);
  refuses(RegisterType::f32, 1e39);
  for (const RegisterType type : {RegisterType::u16, RegisterType::i32, RegisterType::f32}) {
    refuses(type, std::numeric_limits<double>::quiet_NaN());
    refuses(type, std::numeric_limits<double>::infinity());
  }
}

TEST(RegisterCodec, SaysWhatARegisterHoldsWhenAValueDoesNotFit) {
  const std::string message = testing::thrown_message<RegisterRangeError>(
      [] { encoded(entry(RegisterType::i16, 0.1), WordOrder::big, 5000); });
  EXPECT_EQ(message, "register value: 5000 um does not fit; it holds -3276.8 to 3276.7");
}

TEST(RegisterCodec, RefusesTooFewRegisters) {
  std::array<std::uint16_t, 1> one{};
  EXPECT_THROW(encode(entry(RegisterType::u32), 1, one), std::invalid_argument);
  EXPECT_THROW(decode(entry(RegisterType::u32), one), std::invalid_argument);
}

}  // namespace
}  // namespace biotomy::bridge
