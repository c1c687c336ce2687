#include "tools/image_list.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tools {
namespace {

using testing::ElementsAre;

class ImageList : public testing::Test {
 protected:
  std::string put(const std::string& name) const {
    reconstruct::write_text(folder_ / name, "");
    return (folder_ / name).string();
  }

  tests::TemporaryFolder folder_;
};

TEST_F(ImageList, OfAFolderIsInTheOrderOfTheNumbers) {
  const std::string ten = put("face10.png");
  const std::string two = put("face2.TIF");
  const std::string three = put("face03.jpg");
  put("notes.txt");
  put(".hidden.png");
  EXPECT_THAT(list_images({folder_.path().string()}), ElementsAre(two, three, ten));
}

TEST_F(ImageList, OfFilesIsAsTheyStand) {
  const std::string b = put("b.png");
  const std::string a = put("a.png");
  EXPECT_THAT(list_images({b, a}), ElementsAre(b, a));
}

TEST_F(ImageList, RefusesWhatIsNotThereAndAFolderWithoutImages) {
  EXPECT_THROW(list_images({(folder_ / "nowhere").string()}), reconstruct::SampleError);
  EXPECT_THROW(list_images({folder_.path().string()}), reconstruct::SampleError);
}

TEST(ComesBefore, ComparesNumbersByTheirValueAndAllElseAsText) {
  EXPECT_TRUE(comes_before("a9", "a10"));
  EXPECT_FALSE(comes_before("a10", "a9"));
  EXPECT_TRUE(comes_before("a9z2", "a09z10"));
  EXPECT_TRUE(comes_before("a", "a1"));
  EXPECT_TRUE(comes_before("a1", "b0"));
  EXPECT_FALSE(comes_before("a1", "a1"));
  // Of one value: a fixed order, whichever.
  EXPECT_NE(comes_before("a01", "a1"), comes_before("a1", "a01"));
}

}  // namespace
}  // namespace biotomy::tools
