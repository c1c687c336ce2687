#include "reconstruct/store/layer_band.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ALayerBand : public testing::Test {
 protected:
  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {300, 20, 9}, 8, 5);
};

TEST_F(ALayerBand, GivesTheSameRegionOfEachLayer) {
  const cv::Rect region(250, 3, 50, 11);
  const auto layers = LayerBand(sample_, 2, 3).read(region);
  ASSERT_EQ(layers.size(), 3U);
  for (std::uint64_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(same_pixels(layers[k], test_image(300, 20, CV_8UC3, k + 2)(region))) << k;
  }
}

TEST(ADeepLayerBand, NeedsFewerOpenFilesThanItHasLayers) {
  const tests::TemporaryFolder folder;
  const SampleFolder sample = sample_with_layers(folder / "s", {8, 6, 400}, 8, 400);
  rlimit limits{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limits), 0);
  const rlimit fewer{320, limits.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &fewer), 0);
  const auto layers = LayerBand(sample, 1, 400).read({2, 1, 3, 4});
  ::setrlimit(RLIMIT_NOFILE, &limits);
  ASSERT_EQ(layers.size(), 400U);
  for (const std::uint64_t k : {0U, 255U, 256U, 399U}) {
    EXPECT_TRUE(same_pixels(layers[k], test_image(8, 6, CV_8UC3, k + 1)({2, 1, 3, 4}))) << k;
  }
}

TEST_F(ALayerBand, NamesALayerThatIsMissingOrOfAnotherSize) {
  EXPECT_THAT(message_of<SampleError>([&] { LayerBand(sample_, 4, 3); }), HasSubstr("000006.tif"));
  write_layer_image(sample_.layer_path(3), test_image(300, 21), {3, {1, 1, 1}}, {});
  EXPECT_THAT(message_of<SampleError>([&] { LayerBand(sample_, 1, 4); }),
              AllOf(HasSubstr("000003.tif"), HasSubstr("300 × 21")));
}

}  // namespace
}  // namespace biotomy::reconstruct
