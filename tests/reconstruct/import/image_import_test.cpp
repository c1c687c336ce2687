#include "reconstruct/import/image_import.hpp"

#include <atomic>
#include <stdexcept>

#include <gmock/gmock.h>

#include "reconstruct/disk/sha256.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_hashes.hpp"
#include "reconstruct/store/volume.hpp"
#include "reconstruct/store/volume_verification.hpp"
#include "tests/reconstruct/findings.hpp"
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
  SampleFolder import(const ImportProgress& progress = {}, const StopRequested& stop = {}) {
    return import_images(ImageSequence::find({images_}), request_, progress, stop);
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

TEST_F(ImageImport, WritesDownWhichLayersHaveNoPhotograph) {
  save_layers(6);
  std::filesystem::remove(images_ / "4.png");
  const auto images = ImageSequence::find({images_}, {.repeats_over_gaps = true});
  const SampleFolder sample = import_images(images, request_);
  EXPECT_THAT(sample.description().repeated_layers, ElementsAre(4));
  EXPECT_EQ(sample.description().cuboid.size.z, 6);
  for (const int layer : {3, 4}) {
    EXPECT_TRUE(
        same_pixels(read_layer_image(sample.layer_path(layer)), test_image(40, 30, CV_8UC3, 3)));
  }
  EXPECT_TRUE(same_pixels(read_layer_image(sample.layer_path(5)), test_image(40, 30, CV_8UC3, 5)));
}

TEST_F(ImageImport, SizeIsDividedByTheNumberOfVoxels) {
  save_layers(5);
  request_.scale = StackSize{{400.0, 600.0, 50.0}};
  EXPECT_EQ(import().description().cuboid.spacing, (Vector3{10.0, 20.0, 10.0}));
}

TEST_F(ImageImport, TellsItsProgress) {
  save_layers(5);
  std::vector<std::int64_t> done;
  const auto note = [&](std::int64_t layers, std::int64_t total) {
    done.push_back(layers);
    EXPECT_EQ(total, 5);
  };
  import(note);
  EXPECT_THAT(done, ElementsAre(1, 2, 3, 4, 5));
}

TEST_F(ImageImport, LeavesNothingWhenTheFirstImageIsDamaged) {
  save_layers(9);
  const auto images = ImageSequence::find({images_});
  for (int i = 1; i <= 9; ++i) {
    truncate_file(images_ / (std::to_string(i) + ".png"), 0.6);
  }
  EXPECT_THAT(message_of<SampleError>([&] { import_images(images, request_); }),
              testing::AllOf(HasSubstr("truncated"), testing::Not(HasSubstr("kept"))));
  EXPECT_TRUE(output_names().empty());
}

TEST_F(ImageImport, KeepsWhatItHasWhenALaterImageIsDamagedAndSaysSo) {
  save_layers(9);
  request_.most_band_bytes = 0;  // so that the first band is stored before the second is read
  truncate_file(images_ / "7.png", 0.6);
  EXPECT_THAT(message_of<SampleError>([&] { import(); }),
              testing::AllOf(HasSubstr("7.png"), HasSubstr("truncated"), HasSubstr("of 9 layers"),
                             HasSubstr("the same command goes on"), HasSubstr("--restart")));
  EXPECT_THAT(output_names(), ElementsAre(".sample.partial"));
  save_layers(9);
  EXPECT_THAT(message_of<SampleError>([&] { import(); }), HasSubstr("--restart"));
  request_.restart = true;
  import();
  EXPECT_THAT(output_names(), ElementsAre("sample"));
}

TEST_F(ImageImport, TellsWhenAnImageHasAnotherSize) {
  save_layers(3);
  save_rgb(images_ / "4.png", test_image(41, 30));
  EXPECT_THAT(message_of<SampleError>([&] { import(); }), HasSubstr("expected 40 × 30"));
}

TEST_F(ImageImport, WritesTheHashesOfTheLayersInOrder) {
  save_layers(5);
  const SampleFolder sample = import();
  const auto hashes = read_layer_hashes(sample.hashes_path());
  ASSERT_EQ(hashes.size(), 5U);
  for (std::int64_t layer = 1; layer <= 5; ++layer) {
    const LayerHash& each = hashes[static_cast<std::size_t>(layer - 1)];
    EXPECT_EQ(sample.path() / each.file, sample.layer_path(layer));
    EXPECT_EQ(each.sha256, sha256_of_file(sample.layer_path(layer)));
  }
}

TEST_F(ImageImport, MakesTheSameOfABandInMemoryAndOfItsFiles) {
  save_layers(10);
  const auto in_memory = contents_of(import().path());
  request_.output = folder_.path() / "out" / "other";
  request_.most_band_bytes = 0;
  EXPECT_THAT(differing_files(contents_of(import().path()), in_memory), testing::IsEmpty());
}

TEST_F(ImageImport, MakesTheSameHoweverOftenItWasInterrupted) {
  save_layers(14);
  const auto undisturbed = contents_of(import().path());
  for (const std::size_t most_band_bytes : {std::size_t{0}, std::size_t{1} << 30}) {
    request_.output = folder_.path() / "out" / ("other" + std::to_string(most_band_bytes));
    request_.most_band_bytes = most_band_bytes;
    cv::RNG random(7);
    int interruptions = 0;
    for (bool finished = false; !finished;) {
      std::atomic<int> questions{0};
      // Grows, because a slow disk may have kept nothing of what came before.
      const int patience = random.uniform(1, 8) + interruptions;
      try {
        const SampleFolder sample = import({}, [&] { return ++questions > patience; });
        EXPECT_THAT(differing_files(contents_of(sample.path()), undisturbed), testing::IsEmpty());
        finished = true;
      } catch (const Interrupted&) {
        ++interruptions;
      }
    }
    EXPECT_GT(interruptions, 1);
  }
}

TEST_F(ImageImport, PutsALayerIntoItsVolumeAnewWhenItsFileWasNotStored) {
  save_layers(9);
  request_.most_band_bytes = 0;  // so that the first bands are in the volume before image 9 is read
  truncate_file(images_ / "9.png", 0.6);
  EXPECT_THROW(import(), SampleError);
  // As if the failure had come while the file was waiting for the disk.
  const auto partial = folder_ / "out" / ".sample.partial";
  auto hashes = read_layer_hashes(partial / "layers.sha256");
  std::erase_if(hashes, [](const LayerHash& each) { return each.file == "layers/000002.tif"; });
  ASSERT_EQ(hashes.size(), 7U);
  write_text(partial / "layers.sha256", layer_hash_lines(hashes));
  for (const int layer : {2, 9}) {
    save_rgb(images_ / (std::to_string(layer) + ".png"), test_image(40, 30, CV_8UC3, 99));
  }
  HeardFindings heard(folder_.path());
  verify_volume(import(), true, heard.listener());
  EXPECT_THAT(heard.findings, testing::IsEmpty());
}

TEST_F(ImageImport, MakesTheSameAfterFaultsWhileLayersAreStored) {
  save_layers(14);
  const auto undisturbed = contents_of(import().path());
  request_.output = folder_.path() / "out" / "other";
  int faults = 0;
  for (bool finished = false; !finished;) {
    int stored = 0;
    try {
      const SampleFolder sample = import([&](std::int64_t, std::int64_t) {
        if (++stored == 3) {
          throw std::runtime_error("the disk is gone");
        }
      });
      EXPECT_THAT(differing_files(contents_of(sample.path()), undisturbed), testing::IsEmpty());
      finished = true;
    } catch (const SampleError& error) {
      EXPECT_THAT(error.what(), HasSubstr("the disk is gone; "));
      ++faults;
    }
  }
  EXPECT_GT(faults, 1);  // at most 6 layers are stored before each
}

TEST_F(ImageImport, InterruptedBeforeTheFirstLayerLeavesNothing) {
  save_layers(3);
  EXPECT_THROW(import({}, [] { return true; }), Interrupted);
  EXPECT_TRUE(output_names().empty());
}

TEST_F(ImageImport, TakenUpAgainKeepsTheTimeOfItsBeginning) {
  save_layers(9);
  request_.created = "2026-01-02T03:04:05Z";
  request_.most_band_bytes = 0;  // so that a band's layers are stored before it is appended
  std::atomic<bool> stored{false};
  EXPECT_THROW(
      import([&](std::int64_t, std::int64_t) { stored = true; }, [&] { return stored.load(); }),
      Interrupted);
  request_.created = "2026-02-02T03:04:05Z";
  EXPECT_EQ(import().description().created, "2026-01-02T03:04:05Z");
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

TEST_F(ImageImport, RefusesAnOutputThatIsALink) {
  save_layers(2);
  std::filesystem::create_directory(folder_ / "elsewhere");
  std::filesystem::create_directory_symlink(folder_ / "elsewhere", request_.output);
  EXPECT_THAT(message_of<SampleError>([&] { import(); }), HasSubstr("is a symbolic link"));
}

TEST_F(ImageImport, RefusesSpacingsOfWhichACoarserLevelMakesNoSense) {
  save_layers(2);
  request_.scale = VoxelSpacing{{1e7, 1e7, 1e7}};
  request_.layout.chunk = {1, 2, 2};
  request_.layout.shard = {1, 4, 4};
  EXPECT_NO_THROW(import());
  std::filesystem::remove_all(request_.output);
  request_.scale = VoxelSpacing{{5e8, 5e8, 5e8}};
  EXPECT_THROW(import(), InvalidRequest);
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

}  // namespace
}  // namespace biotomy::reconstruct
