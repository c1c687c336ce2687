#include "reconstruct/section/interpolation.hpp"

#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

TEST(Interpolation, IsNamedAsInTheOptions) {
  EXPECT_EQ(interpolation("nearest"), Interpolation::nearest);
  EXPECT_EQ(interpolation("linear"), Interpolation::linear);
}

TEST(Interpolation, RefusesANameThatIsNotThereAndSaysWhichAre) {
  try {
    interpolation("lanczos");
    FAIL() << "no error";
  } catch (const InvalidRequest& error) {
    EXPECT_THAT(std::string(error.what()),
                testing::AllOf(testing::HasSubstr("lanczos"), testing::HasSubstr("nearest"),
                               testing::HasSubstr("linear")));
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
