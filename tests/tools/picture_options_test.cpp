#include "tools/picture_options.hpp"

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"

namespace biotomy::tools {
namespace {

TEST(PictureOptions, HaveAQualityInWholeNumbers) {
  EXPECT_EQ(jpeg_quality({}), 90);
  EXPECT_EQ(jpeg_quality({"1"}), 1);
  EXPECT_EQ(jpeg_quality({"100"}), 100);
}

TEST(PictureOptions, RefuseOtherQualities) {
  for (const char* text : {"0", "101", "50.5", "-3", "good", ""}) {
    EXPECT_THROW(jpeg_quality({text}), reconstruct::InvalidRequest) << text;
  }
}

}  // namespace
}  // namespace biotomy::tools
