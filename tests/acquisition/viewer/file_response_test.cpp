#include "acquisition/viewer/file_response.hpp"

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

TEST(AByteRange, IsWhatTheHeaderAsksForOrAll) {
  const auto range = [](const char* header) { return byte_range(header, 100); };
  EXPECT_EQ(range(""), (ByteRange{0, 100}));
  EXPECT_EQ(range("bytes=0-0"), (ByteRange{0, 1}));
  EXPECT_EQ(range("bytes=10-19"), (ByteRange{10, 10}));
  EXPECT_EQ(range("bytes=90-"), (ByteRange{90, 10}));
  EXPECT_EQ(range("bytes=90-999"), (ByteRange{90, 10}));
  EXPECT_EQ(range("bytes=-10"), (ByteRange{90, 10}));
  EXPECT_EQ(range("bytes=-1000"), (ByteRange{0, 100}));
  EXPECT_EQ(range("bytes=100-"), std::nullopt);
  EXPECT_EQ(range("bytes=-0"), std::nullopt);
  for (const char* header : {"bytes=5-4", "bytes=0-1,5-6", "lines=1-2", "bytes=", "bytes=-",
                             "bytes=a-b", "bytes=--1", "bytes=1-99999999999999999999"}) {
    EXPECT_EQ(range(header), (ByteRange{0, 100})) << header;
  }
  EXPECT_EQ(byte_range("bytes=-5", 0), std::nullopt);
}

}  // namespace
}  // namespace biotomy::acquisition
