#include "reconstruct/export/tiff_stack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <sys/resource.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_file.hpp"
#include "reconstruct/picture/picture_description.hpp"
#include "reconstruct/picture/tiff_file.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/volume_levels.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

class ATiffStack : public testing::TestWithParam<int> {
 protected:
  ATiffStack() {
    layout_.chunk = {4, 8, 16};
    layout_.shard = {8, 16, 32};
    VolumeWriter(sample_, layout_).append(11, true);
    request_.output = folder_ / "out";
  }
  auto sorted_names() const {
    auto names = names_in(request_.output);
    std::sort(names.begin(), names.end());
    return names;
  }

  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {90, 45, 11}, GetParam(), 11);
  VolumeLayout layout_;
  ExportRequest request_;
};

TEST_P(ATiffStack, HoldsEveryLayerOfALevel) {
  const Volume volume = Volume::open(sample_.volume_path());
  for (const int level : {0, 1}) {
    request_.level = level;
    request_.output = folder_ / ("out" + std::to_string(level));
    export_tiff_stack(volume, request_);
    const auto expected = stored_level(volume, level);
    ASSERT_EQ(sorted_names().size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_TRUE(same_pixels(read_image_file(request_.output / sorted_names()[k]), expected[k]))
          << level << ", " << k;
    }
  }
}

TEST_P(ATiffStack, HoldsARegionNumberedByItsLayers) {
  request_.region = "17:40,3:44,2:10";
  export_tiff_stack(Volume::open(sample_.volume_path()), request_);
  EXPECT_EQ(sorted_names().front(), "000003.tif");
  EXPECT_EQ(sorted_names().back(), "000010.tif");
  const int type = GetParam() == 8 ? CV_8UC3 : CV_16UC3;
  EXPECT_TRUE(same_pixels(read_image_file(request_.output / "000003.tif"),
                          test_image(90, 45, type, 3)(cv::Rect(17, 3, 23, 41))));
}

TEST_P(ATiffStack, IsPlainEnoughForAnyReader) {
  export_tiff_stack(Volume::open(sample_.volume_path()), request_);
  const TiffFile file = TiffFile::open(request_.output / "000001.tif");
  EXPECT_EQ(TIFFIsTiled(file.get()), 0);
  EXPECT_EQ(file.number<std::uint16_t>(TIFFTAG_COMPRESSION, 0), COMPRESSION_ADOBE_DEFLATE);
  EXPECT_EQ(file.number<std::uint16_t>(TIFFTAG_PREDICTOR, 1), 1);
  EXPECT_FLOAT_EQ(file.number<float>(TIFFTAG_XRESOLUTION, 0), 1000.0F);  // 10 micrometres
  const std::string spacing = std::to_string(std::lround(sample_.description().cuboid.spacing.z));
  EXPECT_EQ(picture_description(request_.output / "000001.tif"),
            "ImageJ=1.53t\nunit=um\nspacing=" + spacing + "\n");
}

TEST_P(ATiffStack, LeavesNothingWhenAChunkIsDamagedOrItIsInterrupted) {
  const auto shard = sample_.volume_path() / "0" / "c" / "0" / "1" / "0" / "0";
  request_.stop = [] { return true; };
  EXPECT_THROW(export_tiff_stack(Volume::open(sample_.volume_path()), request_), Interrupted);
  request_.stop = {};
  flip_byte(shard, 5);
  EXPECT_THAT(message_of<SampleError>(
                  [&] { export_tiff_stack(Volume::open(sample_.volume_path()), request_); }),
              testing::HasSubstr(shard.string()));
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("s"));
}

TEST(ADeepTiffStack, NeedsFewerOpenFilesThanAChunkHasLayers) {
  const tests::TemporaryFolder folder;
  const SampleFolder sample = sample_with_layers(folder / "s", {8, 6, 400}, 8, 400);
  VolumeLayout layout;
  layout.chunk = {400, 8, 8};
  layout.shard = {400, 8, 8};
  VolumeWriter(sample, layout).append(400, true);
  const Volume volume = Volume::open(sample.volume_path());
  ExportRequest request;
  request.output = folder / "out";
  rlimit limits{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limits), 0);
  const rlimit fewer{320, limits.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &fewer), 0);
  EXPECT_NO_THROW(export_tiff_stack(volume, request));
  ::setrlimit(RLIMIT_NOFILE, &limits);
  for (const std::uint64_t layer : {1U, 256U, 257U, 400U}) {
    std::array<char, 16> name{};
    std::snprintf(name.data(), name.size(), "%06d.tif", static_cast<int>(layer));
    EXPECT_TRUE(same_pixels(read_image_file(request.output / name.data()),
                            test_image(8, 6, CV_8UC3, layer)));
  }
}

INSTANTIATE_TEST_SUITE_P(Bits, ATiffStack, testing::Values(8, 16));

}  // namespace
}  // namespace biotomy::reconstruct
