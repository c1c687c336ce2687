#include "reconstruct/picture/image_file.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::StartsWith;
using tests::TemporaryFolder;

class ImageFile : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  TemporaryFolder folder_;
};

TEST_F(ImageFile, LosslessFormatsGiveBackTheSamePixels) {
  for (const char* name : {"a.png", "b.TIF", "c.tiff", "d.PNG"}) {
    for (const int type : {CV_8UC3, CV_16UC3}) {
      const cv::Mat image = test_image(70, 50, type);
      save_rgb(path(name), image);
      EXPECT_TRUE(same_pixels(read_image_file(path(name)), image)) << name;
    }
  }
}

TEST_F(ImageFile, JpegHasItsColoursInOrder) {
  save_rgb(path("a.jpg"), cv::Mat(32, 32, CV_8UC3, cv::Scalar(200, 100, 20)));
  const cv::Mat image = read_image_file(path("a.jpg"));
  EXPECT_LE(cv::norm(image.at<cv::Vec3b>(10, 10), cv::Vec3b(200, 100, 20), cv::NORM_INF), 3.0);
}

TEST_F(ImageFile, GreyBecomesRgb) {
  cv::imwrite(path("a.png").string(), cv::Mat(5, 5, CV_16UC1, cv::Scalar(1234)));
  const cv::Mat image = read_image_file(path("a.png"));
  EXPECT_EQ(image.type(), CV_16UC3);
  EXPECT_EQ(image.at<cv::Vec3w>(2, 2), cv::Vec3w(1234, 1234, 1234));
}

TEST_F(ImageFile, TransparencyIsDroppedAndTheColourKept) {
  cv::imwrite(path("a.png").string(), cv::Mat(5, 5, CV_8UC4, cv::Scalar(30, 20, 10, 0)));  // BGRA
  EXPECT_EQ(read_image_file(path("a.png")).at<cv::Vec3b>(2, 2), cv::Vec3b(10, 20, 30));
}

TEST_F(ImageFile, TruncatedFileOfEveryKindIsAnErrorAndPrintsNothing) {
  for (const char* name : {"a.png", "b.jpg", "c.tif"}) {
    for (const double share : {0.0, 0.1, 0.5, 0.9, 0.99}) {
      save_rgb(path(name), test_image(300, 200));
      truncate_file(path(name), share);
      testing::internal::CaptureStderr();
      const std::string message = message_of<SampleError>([&] { read_image_file(path(name)); });
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name;
      EXPECT_THAT(message, StartsWith(path(name).string() + ": ")) << name << ' ' << share;
    }
  }
}

TEST_F(ImageFile, FileThatIsNotWhatItsNameSaysIsAnError) {
  for (const char* name : {"a.png", "b.jpg", "c.tif"}) {
    write_text(path(name), "this is no image at all, whatever its name says");
    EXPECT_THROW(read_image_file(path(name)), SampleError) << name;
  }
}

TEST_F(ImageFile, MissingFileIsAnError) {
  for (const char* name : {"a.png", "c.tif", "d.bmp"}) {
    EXPECT_THROW(read_image_file(path(name)), SampleError) << name;
  }
}

TEST(ImageName, IsToldByTheExtensionInAnyCase) {
  EXPECT_TRUE(is_image_name("a/b.PNG"));
  EXPECT_TRUE(is_image_name("1.jpeg"));
  EXPECT_FALSE(is_image_name("1.txt"));
  EXPECT_FALSE(is_image_name("png"));
}

}  // namespace
}  // namespace biotomy::reconstruct
