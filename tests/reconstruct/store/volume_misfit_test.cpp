#include "reconstruct/store/volume_misfit.hpp"

#include <gmock/gmock.h>

#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::Optional;

class AMisfit : public testing::Test {
 protected:
  std::optional<std::string> of(const Cuboid& cuboid, int bits) const {
    return misfit(cuboid, bits, sample_);
  }
  std::string sentence(const std::string& differences) const {
    return "does not fit the sample's description: " + differences +
           "; if sample.toml is right, biotomy rebuild " + sample_.path().string() +
           " makes the volume anew";
  }

  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {30, 20, 8}, 8, 0, {10.0, 11.0, 50.0});
};

TEST_F(AMisfit, IsNoneWhereAllIsAlike) {
  EXPECT_EQ(of({{30, 20, 8}, {10.0, 11.0, 50.0}}, 8), std::nullopt);
}

TEST_F(AMisfit, NamesTheValueWithBothItsNumbersAndTheRemedy) {
  EXPECT_THAT(of({{30, 20, 8}, {10.0, 11.0, 25.5}}, 8),
              Optional(sentence("spacing_um.z is 25.5, in sample.toml 50")));
  EXPECT_THAT(of({{30, 20, 8}, {10.0, 11.0, 50.0}}, 16),
              Optional(sentence("bits is 16, in sample.toml 8")));
}

TEST_F(AMisfit, NamesEveryValue) {
  EXPECT_THAT(
      of({{31, 20, 9}, {10.0, 12.0, 50.0}}, 8),
      Optional(sentence("grid.width is 31, in sample.toml 30; grid.layers is 9, in sample.toml 8; "
                        "spacing_um.y is 12, in sample.toml 11")));
}

TEST_F(AMisfit, ShowsADifferenceInTheLastDigit) {
  EXPECT_THAT(of({{30, 20, 8}, {10.000000000000002, 11.0, 50.0}}, 8),
              Optional(sentence("spacing_um.x is 10.000000000000002, in sample.toml 10")));
}

}  // namespace
}  // namespace biotomy::reconstruct
