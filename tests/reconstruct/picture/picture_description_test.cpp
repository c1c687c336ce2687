#include "reconstruct/picture/picture_description.hpp"

#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/jpeg_writer.hpp"
#include "reconstruct/picture/png_writer.hpp"
#include "reconstruct/picture/tiff_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

class PictureDescription : public testing::Test {
 protected:
  PictureNotes notes(const std::string& description) const { return {10.0, "knee", description}; }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.png";
  cv::Mat image_ = test_image(12, 9);
};

TEST_F(PictureDescription, IsWhatAPngWasWrittenWith) {
  for (const std::string words : {"{}", "one of a picture"}) {
    write_file(path_, encode_png(image_, notes(words)));
    EXPECT_EQ(picture_description(path_), words);
  }
}

TEST_F(PictureDescription, IsWhatATiffWasWrittenWith) {
  write_file(path_, encode_tiff(image_, notes("one of a TIFF, whatever it is called")));
  EXPECT_EQ(picture_description(path_), "one of a TIFF, whatever it is called");
}

TEST_F(PictureDescription, IsNoneWhereThereIsNone) {
  write_file(path_, encode_png(image_, notes("")));
  EXPECT_EQ(picture_description(path_), std::nullopt);
  write_file(path_, encode_tiff(image_, notes("")));
  EXPECT_EQ(picture_description(path_), std::nullopt);
  write_file(path_, encode_jpeg(image_, notes("a comment"), 90));
  EXPECT_EQ(picture_description(path_), std::nullopt);
}

TEST_F(PictureDescription, NamesAFileThatCannotBeRead) {
  EXPECT_THAT(message_of<SampleError>([&] { picture_description(path_); }),
              HasSubstr(path_.string() + ": cannot be read"));
  auto file = encode_png(image_, notes(std::string(5000, 'a')));
  file.resize(4000);
  write_file(path_, file);
  EXPECT_THAT(message_of<SampleError>([&] { picture_description(path_); }),
              HasSubstr(path_.string() + ": is cut off"));
}

TEST_F(PictureDescription, OfMoreThanAMebibyteIsRefused) {
  for (const bool png : {true, false}) {
    const PictureNotes long_notes = notes(std::string((std::size_t{1} << 20) + 1, 'a'));
    write_file(path_, png ? encode_png(image_, long_notes) : encode_tiff(image_, long_notes));
    EXPECT_THAT(message_of<SampleError>([&] { picture_description(path_); }),
                HasSubstr("more of itself than 1 MiB"));
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
