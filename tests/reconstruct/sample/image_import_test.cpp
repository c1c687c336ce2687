#include "reconstruct/sample/image_import.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::TemporaryFolder;

class ImageImport : public testing::Test {
 protected:
  ImageImport() {
    std::filesystem::create_directory(images_);
    request_.output = folder_.path() / "out" / "sample";
    std::filesystem::create_directory(folder_.path() / "out");
    request_.name = "sample";
    request_.scale = VoxelSpacing{{1.0, 2.0, 3.0}};
    request_.layout.chunk = {4, 16, 16};
    request_.layout.shard = {4, 32, 32};
  }

  void save_layers(int count) {
    for (int i = 1; i <= count; ++i) {
      save_rgb(images_ / (std::to_string(i) + ".png"),
               test_image(40, 30, CV_8UC3, static_cast<std::uint64_t>(i)));
    }
  }
  SampleFolder import(const ImportProgress& progress = {}) {
    return import_images(ImageSequence::find({images_}), request_, progress);
  }
  std::vector<std::string> output_names() const { return names_in(folder_.path() / "out"); }

  TemporaryFolder folder_;
  std::filesystem::path images_ = folder_.path() / "images";
  ImportRequest request_;
};

TEST_F(ImageImport, MakesASampleWithAllLayersAndTheirVolume) {
  save_layers(10);
  const SampleFolder sample = import();
  EXPECT_EQ(sample.description().cuboid.size, (GridSize{40, 30, 10}));
  EXPECT_EQ(sample.description().cuboid.spacing, (Vector3{1.0, 2.0, 3.0}));
  for (int i = 1; i <= 10; ++i) {
    EXPECT_TRUE(same_pixels(read_layer_image(sample.layer_path(i)),
                            test_image(40, 30, CV_8UC3, static_cast<std::uint64_t>(i))));
  }
  EXPECT_EQ(Volume::open(sample.volume_path()).layers_present(), 10);
  EXPECT_THAT(output_names(), ElementsAre("sample"));
}

TEST_F(ImageImport, SizeIsDividedByTheNumberOfVoxels) {
  save_layers(5);
  request_.scale = StackSize{{400.0, 600.0, 50.0}};
  EXPECT_EQ(import().description().cuboid.spacing, (Vector3{10.0, 20.0, 10.0}));
}

TEST_F(ImageImport, TellsItsProgress) {
  save_layers(5);
  std::vector<std::int64_t> done;
  import([&](std::int64_t layers, std::int64_t total) {
    done.push_back(layers);
  EXPECT_EQ(total, 5);
});
EXPECT_THAT(done, ElementsAre(1, 2, 3, 4, 5));
}  // namespace

TEST_F(ImageImport, LeavesNothingWhenAnImageIsTruncated) {
  save_layers(9);
  truncate_file(images_ / "7.png", 0.6);
  EXPECT_THAT(message_of<SampleError>([&] { import(); }),
              testing::AllOf(HasSubstr("7.png"), HasSubstr("truncated")));
  EXPECT_TRUE(output_names().empty());
}

TEST_F(ImageImport, LeavesNothingWhenAnImageHasAnotherSize) {
  save_layers(3);
  save_rgb(images_ / "4.png", test_image(41, 30));
  EXPECT_THAT(message_of<SampleError>([&] { import(); }), HasSubstr("expected 40 × 30"));
  EXPECT_TRUE(output_names().empty());
}

TEST_F(ImageImport, RefusesASampleFolderThatIsThereAndTouchesNothingInIt) {
  save_layers(2);
  std::filesystem::create_directory(request_.output);
  write_text(request_.output / "precious", "x");
  EXPECT_THAT(message_of<SampleError>([&] { import(); }), HasSubstr("not empty"));
  EXPECT_THAT(names_in(request_.output), ElementsAre("precious"));
  EXPECT_THAT(output_names(), ElementsAre("sample"));
}

TEST_F(ImageImport, MayFillAnEmptyFolder) {
  save_layers(2);
  std::filesystem::create_directory(request_.output);
  EXPECT_NO_THROW(import());
}

TEST_F(ImageImport, RefusesASpacingOfZero) {
  save_layers(2);
  request_.scale = VoxelSpacing{{1.0, 0.0, 1.0}};
  EXPECT_THROW(import(), InvalidRequest);
  EXPECT_TRUE(output_names().empty());
}

TEST_F(ImageImport, RefusesALayoutThatCannotBe) {
  save_layers(2);
  request_.layout.codec = "zip";
  EXPECT_THROW(import(), InvalidRequest);
  EXPECT_TRUE(output_names().empty());
}

}  // namespace biotomy::reconstruct
}  // namespace biotomy::reconstruct
