#include "reconstruct/import/image_sequence.hpp"

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using tests::TemporaryFolder;

class Sequence : public testing::Test {
 protected:
  void save(const std::string& name, int width = 8, int type = CV_8UC3) {
    save_rgb(folder_.path() / name, test_image(width, 6, type));
  }
  ImageSequence find(const ImageNumbering& numbering = {}) const {
    return ImageSequence::find({folder_.path()}, numbering);
  }
  std::string error(const ImageNumbering& numbering = {}) const {
    return message_of<SampleError>([&] { find(numbering); });
  }
  static std::vector<std::string> names(const ImageSequence& sequence) {
    std::vector<std::string> names;
    for (const auto& file : sequence.files()) {
      names.push_back(file.filename().string());
    }
    return names;
  }

  TemporaryFolder folder_;
};

TEST_F(Sequence, IsInTheOrderOfTheNumbersNotOfTheNames) {
  for (int i = 1; i <= 10; ++i) {
    save("face" + std::to_string(i) + ".png");
  }
  const ImageSequence sequence = find();
  EXPECT_EQ(sequence.count(), 10);
  EXPECT_EQ(names(sequence).at(1), "face2.png");
  EXPECT_EQ(names(sequence).at(9), "face10.png");
}

TEST_F(Sequence, TakesTheLastNumberOfTheName) {
  save("knee42_07_raw.png");
  save("knee42_08_raw.png");
  EXPECT_THAT(names(find()), testing::ElementsAre("knee42_07_raw.png", "knee42_08_raw.png"));
}

TEST_F(Sequence, TakesFilesInAnyOrder) {
  save("2.png");
  save("1.png");
  const auto sequence = ImageSequence::find({folder_.path() / "2.png", folder_.path() / "1.png"});
  EXPECT_THAT(names(sequence), testing::ElementsAre("1.png", "2.png"));
}

class SequenceOfPages : public Sequence {
 protected:
  SequenceOfPages() {
    for (unsigned i = 0; i < 4; ++i) {
      pages_.push_back(test_image(8, 6, CV_8UC3, i));
    }
  }
  void save_pages() const {
    std::vector<cv::Mat> bgr(pages_.size());
    for (std::size_t i = 0; i < pages_.size(); ++i) {
      cv::cvtColor(pages_[i], bgr[i], cv::COLOR_RGB2BGR);
    }
    cv::imwritemulti(path_.string(), bgr);
  }

  std::filesystem::path path_ = folder_ / "stack.tif";
  std::vector<cv::Mat> pages_;
};

TEST_F(SequenceOfPages, IsThoseOfOneFileInTheirOrder) {
  save_pages();
  const ImageSequence sequence = ImageSequence::find({path_});
  ASSERT_EQ(sequence.count(), 4);
  EXPECT_EQ(sequence.files(), std::vector<std::filesystem::path>(4, path_));
  for (std::int64_t layer = 1; layer <= 4; ++layer) {
    EXPECT_TRUE(same_pixels(sequence.read(layer), pages_[static_cast<std::size_t>(layer - 1)]));
  }
}

TEST_F(SequenceOfPages, NamesAPageOfAnotherSize) {
  pages_[2] = test_image(9, 6);
  save_pages();
  const ImageSequence sequence = ImageSequence::find({path_});
  EXPECT_EQ(message_of<SampleError>([&] { sequence.read(3); }),
            path_.string() +
                ": layer 3 in it is 9 × 6 pixels of 8 bits, expected 8 × 6 pixels of 8 bits like "
                "its first");
}

TEST_F(SequenceOfPages, HasNoNumbers) {
  save_pages();
  EXPECT_THAT(message_of<InvalidRequest>([&] { ImageSequence::find({path_}, {.step = 2}); }),
              AllOf(StartsWith(path_.string()), HasSubstr("--number-step")));
}

TEST_F(SequenceOfPages, IsNoneInAFolderOfFiles) {
  path_ = folder_ / "stack1.tif";
  save_pages();
  EXPECT_THAT(error(), HasSubstr("give this file alone"));
}

TEST_F(Sequence, DoesNotLookAtOtherThingsInTheFolder) {
  save("5.png");
  save("overview.png");
  write_text(folder_.path() / "6.txt", "notes");
  write_text(folder_.path() / ".7.png", "hidden");
  std::filesystem::create_directory(folder_.path() / "8.png");
  EXPECT_THAT(names(find()), testing::ElementsAre("5.png"));
}

TEST_F(Sequence, SaysHowLayersAreNamedWhereNoImageHasANumber) {
  save("stack.tif");
  const auto advice = AllOf(HasSubstr("layer_0001.tif"), HasSubstr("whose pages are the layers"));
  EXPECT_THAT(error(), AllOf(StartsWith((folder_ / "stack.tif").string()), advice));
  EXPECT_THAT(message_of<SampleError>([&] { ImageSequence::find({folder_ / "stack.tif"}); }),
              advice);
}

TEST_F(Sequence, NamesALinkThatLeadsNowhere) {
  save("5.png");
  std::filesystem::create_symlink("nowhere.png", folder_.path() / "6.png");
  EXPECT_THAT(error(), testing::HasSubstr("6.png: is no file"));
}

TEST_F(Sequence, NamesAMissingNumber) {
  save("a08.png");
  save("a10.png");
  EXPECT_THAT(error(), AllOf(StartsWith(folder_.path().string()), HasSubstr("number 9 is missing"),
                             HasSubstr("--gaps repeat"), HasSubstr("--number-step")));
}

TEST_F(Sequence, TakesTheImageBeforeAGapForItsLayersWhereThatIsAskedFor) {
  for (const char* name : {"a03.png", "a04.png", "a06.png", "a09.png"}) {
    save(name);
  }
  const ImageSequence sequence = find({.repeats_over_gaps = true});
  EXPECT_THAT(names(sequence), testing::ElementsAre("a03.png", "a04.png", "a04.png", "a06.png",
                                                    "a06.png", "a06.png", "a09.png"));
  EXPECT_THAT(sequence.repeated(), testing::ElementsAre(3, 5, 6));
}

TEST_F(Sequence, BridgesNoGapInAStackThatHasNone) {
  save("a1.png");
  save("a2.png");
  EXPECT_TRUE(find({.repeats_over_gaps = true}).repeated().empty());
}

TEST_F(Sequence, TakesAFileFarAwayForNoneOfTheStack) {
  save("a1.png");
  save("a1003.png");
  EXPECT_THAT(error({.repeats_over_gaps = true}),
              AllOf(HasSubstr("a1003.png"), HasSubstr("1001 layers missing")));
}

TEST_F(Sequence, BridgesNoMoreLayersThanItHasImages) {
  for (const char* name : {"a10.png", "a11.png", "a15.png"}) {
    save(name);
  }
  EXPECT_EQ(find({.repeats_over_gaps = true}).count(), 6);
  save("a17.png");
  EXPECT_EQ(find({.repeats_over_gaps = true}).count(), 8);
  save("a20.png");
  EXPECT_THAT(error({.repeats_over_gaps = true}),
              AllOf(HasSubstr("of 11 layers 6 are missing"), HasSubstr("--number-step")));
}

TEST_F(Sequence, GoesInTheStepThatIsAskedFor) {
  for (const char* name : {"s0.png", "s10.png", "s30.png"}) {
    save(name);
  }
  EXPECT_THAT(error(), HasSubstr("number 1 is missing between s0.png and s10.png"));
  EXPECT_THAT(error({.step = 10}), HasSubstr("number 20 is missing between s10.png and s30.png"));
  const ImageSequence bridged = find({.step = 10, .repeats_over_gaps = true});
  EXPECT_THAT(names(bridged), testing::ElementsAre("s0.png", "s10.png", "s10.png", "s30.png"));
  EXPECT_THAT(bridged.repeated(), testing::ElementsAre(3));
  save("s35.png");
  EXPECT_THAT(error({.step = 10, .repeats_over_gaps = true}),
              AllOf(HasSubstr("s35.png"), HasSubstr("5 above"), HasSubstr("the step, 10")));
}

TEST_F(Sequence, NamesANumberThatIsThereTwice) {
  save("a1.png");
  save("a01.png");
  EXPECT_THAT(error(), AllOf(HasSubstr("same number"), HasSubstr("a1.png"), HasSubstr("a01.png")));
}

TEST_F(Sequence, RefusesTwoStacksInOneFolder) {
  save("a1.png");
  save("b2.png");
  EXPECT_THAT(error(), AllOf(HasSubstr("b2.png"), HasSubstr("a1.png")));
}

TEST_F(Sequence, RefusesAFolderWithoutImages) {
  EXPECT_THAT(error(), HasSubstr("no images"));
}

TEST_F(Sequence, RefusesAFileWithoutANumberWhenItIsGivenByName) {
  save("a.png");
  EXPECT_THAT(message_of<SampleError>([&] { ImageSequence::find({folder_.path() / "a.png"}); }),
              HasSubstr("no number"));
}

TEST_F(Sequence, RefusesANameThatIsNotThere) {
  EXPECT_THAT(message_of<SampleError>([] { ImageSequence::find({"/nowhere/1.png"}); }),
              StartsWith("/nowhere/1.png: there is no such file"));
}

TEST_F(Sequence, RefusesAnImageOfAnotherSizeOnOneLineThatTellsBoth) {
  save("1.png");
  save("2.png", 9);
  const ImageSequence sequence = find();
  EXPECT_NO_THROW(sequence.read(1));
  EXPECT_EQ(message_of<SampleError>([&] { sequence.read(2); }),
            (folder_.path() / "2.png").string() +
                ": is 9 × 6 pixels of 8 bits, expected 8 × 6 pixels of 8 bits like 1.png");
}

TEST_F(Sequence, RefusesAnImageOfOtherBits) {
  save("1.png");
  save("2.png", 8, CV_16UC3);
  const ImageSequence sequence = find();
  EXPECT_THAT(message_of<SampleError>([&] { sequence.read(2); }), HasSubstr("16 bits"));
}

}  // namespace
}  // namespace biotomy::reconstruct
