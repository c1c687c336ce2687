#include "reconstruct/utf8.hpp"

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

TEST(Utf8, LeavesTextAsItIs) {
  for (const char* text : {"", "knee 042", "\xC3\xA4 \xE2\x82\xAC \xF0\x9F\xA6\xB4", "a\"b\\c\n"}) {
    EXPECT_EQ(utf8_text(text), text);
    EXPECT_TRUE(is_utf8(text));
  }
}

TEST(Utf8, ReplacesWhatIsNone) {
  EXPECT_EQ(utf8_text("k\xE4se"), "k\xEF\xBF\xBDse");
  EXPECT_EQ(utf8_text("cut off \xE2\x82"), "cut off \xEF\xBF\xBD");
  for (const char* bytes : {"k\xE4se", "\xFF", "\xC0\x80", "\xED\xA0\x80"}) {
    EXPECT_FALSE(is_utf8(bytes)) << bytes;
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
