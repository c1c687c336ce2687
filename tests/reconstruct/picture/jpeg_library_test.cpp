#include "reconstruct/picture/jpeg_library.hpp"

#include <string>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

TEST(JpegReport, KeepsTheFirstWarningAndPrintsNothing) {
  JpegReport report;
  jpeg_decompress_struct codec{};
  codec.err = &report.manager;
  jpeg_create_decompress(&codec);
  EXPECT_STREQ(report.message(), "");
  const auto warn = [&](int code) {
    codec.err->msg_code = code;
    (*codec.err->emit_message)(reinterpret_cast<j_common_ptr>(&codec), -1);
  };
  testing::internal::CaptureStderr();
  warn(1);
  const std::string first = report.message();
  warn(2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(first, "");
  EXPECT_EQ(report.message(), first);
  EXPECT_EQ(codec.err->num_warnings, 2);
  jpeg_destroy_decompress(&codec);
}

TEST(JpegReport, JumpsOnAnErrorWithItsMessage) {
  JpegReport report;
  jpeg_decompress_struct codec{};
  codec.err = &report.manager;
  jpeg_create_decompress(&codec);
  if (setjmp(report.place) == 0) {
    const unsigned char none = 0;
    jpeg_mem_src(&codec, &none, 0);
    FAIL() << "there is nothing to read from";
  }
  EXPECT_STRNE(report.message(), "");
  jpeg_destroy_decompress(&codec);
}

}  // namespace
}  // namespace biotomy::reconstruct
