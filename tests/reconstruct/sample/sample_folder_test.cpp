#include "reconstruct/sample/sample_folder.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using tests::TemporaryFolder;

SampleDescription example() {
  SampleDescription description;
  description.name = "knee \"042\" – left";
  description.notes = "two\nlines";
  description.created = "2026-01-02T03:04:05Z";
  description.bits = 16;
  description.cuboid = {{4000, 3000, 1200}, {10.1, 10.2, 1.0 / 3.0}};
  return description;
}

std::string good_toml() {
  return "name = 'a'\ncreated = ''\nnotes = ''\nbits = 8\n[grid]\nlayers = 3\nwidth = 4\n"
         "height = 5\n[spacing_um]\nx = 1\ny = 2.5\nz = 3\n";
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

class SampleToml : public testing::Test {
 protected:
  std::string message_for(const std::string& toml) {
    write_text(folder_.path() / "sample.toml", toml);
    return message_of<SampleError>([&] { SampleFolder::open(folder_.path()); });
  }

  TemporaryFolder folder_;
};

TEST(SampleFolder, IsTheSameWhenItIsOpenedAgain) {
  const TemporaryFolder folder;
  SampleFolder::create(folder.path() / "knee", example());
  const SampleDescription description = SampleFolder::open(folder.path() / "knee").description();
  EXPECT_EQ(description.name, example().name);
  EXPECT_EQ(description.notes, example().notes);
  EXPECT_EQ(description.created, example().created);
  EXPECT_EQ(description.bits, 16);
  EXPECT_EQ(description.cuboid.size, example().cuboid.size);
  EXPECT_EQ(description.cuboid.spacing, example().cuboid.spacing);
}

TEST(SampleFolder, KeepsTextsAsTheyAre) {
  const TemporaryFolder folder;
  int number = 0;
  for (const char* text :
       {"\nabc", "a\n\nb\n", "a\tb", "\"a' \\ ''' b\"", "µm €", "\x01\x7f", ""}) {
    SampleDescription description = example();
    description.name = description.notes = text;
    const auto path = folder.path() / std::to_string(++number);
    SampleFolder::create(path, description);
    EXPECT_EQ(SampleFolder::open(path).description().name, text);
    EXPECT_EQ(SampleFolder::open(path).description().notes, text);
  }
}

TEST(SampleFolder, KeepsWhichLayersHaveNoPhotograph) {
  const TemporaryFolder folder;
  SampleDescription description = example();
  description.cuboid.size.z = 9;
  description.repeated_layers = {2, 5, 9};
  SampleFolder::create(folder.path() / "knee", description);
  EXPECT_EQ(SampleFolder::open(folder.path() / "knee").description().repeated_layers,
            description.repeated_layers);
}

TEST(SampleFolder, CanBeReadWithAllTheRepeatedLayersThatItMayHave) {
  const TemporaryFolder folder;
  SampleDescription description = example();
  description.cuboid.size.z = 1'000'000;
  for (int i = 0; i < 100'000; ++i) {
    description.repeated_layers.push_back(900'001 + i);
  }
  SampleFolder::create(folder.path() / "knee", description);
  EXPECT_EQ(SampleFolder::open(folder.path() / "knee").description().repeated_layers.size(),
            100'000U);
  description.repeated_layers.insert(description.repeated_layers.begin(), 2);
  EXPECT_THAT(
      message_of<SampleError>([&] { SampleFolder::create(folder.path() / "hip", description); }),
      HasSubstr("repeated_layers has more than 100000"));
}

TEST(SampleFolder, IsNotMadeWhereAnythingElseIs) {
  const TemporaryFolder folder;
  for (const char* name : {"a/notes.txt", "b/layers/000001.tif", "c"}) {
    std::filesystem::create_directories((folder.path() / name).parent_path());
    write_text(folder.path() / name, "x");
  }
  for (const char* taken : {"a", "b", "c"}) {
    EXPECT_THAT(
        message_of<SampleError>([&] { SampleFolder::create(folder.path() / taken, example()); }),
        HasSubstr("is there already and not empty"))
        << taken;
  }
}

TEST(SampleFolder, CountsLayerImagesUpToTheFirstGap) {
  const TemporaryFolder folder;
  SampleDescription description = example();
  description.cuboid.size.z = 6;
  const SampleFolder sample = SampleFolder::create(folder.path() / "knee", description);
  EXPECT_EQ(sample.layers_on_disk(1), 0);
  for (const int layer : {1, 2, 4, 5, 6, 7}) {
    write_text(sample.layer_path(layer), "");
  }
  EXPECT_EQ(sample.layers_on_disk(1), 2);
  EXPECT_EQ(sample.layers_on_disk(3), 0);
  EXPECT_EQ(sample.layers_on_disk(4), 3);  // the job ends at 6
  EXPECT_EQ(sample.layers_on_disk(7), 0);
}

TEST(SampleFolder, HasFoldersForLayersAndForRejectedFrames) {
  const TemporaryFolder folder;
  const auto sample = SampleFolder::create(folder.path() / "knee", example());
  EXPECT_THAT(names_in(sample.path()),
              testing::UnorderedElementsAre("sample.toml", "layers", "rejected"));
}

TEST(SampleFolder, NumbersLayersWithSixDigitsAndMoreWhenNeeded) {
  const TemporaryFolder folder;
  const auto sample = SampleFolder::create(folder.path() / "knee", example());
  EXPECT_EQ(sample.layer_path(42), folder.path() / "knee" / "layers" / "000042.tif");
  EXPECT_EQ(sample.layer_path(1000000).filename(), "1000000.tif");
}

TEST(SampleFolder, MayBeMadeInAnEmptyFolder) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(SampleFolder::create(folder.path(), example()));
}

TEST(SampleFolder, MayBeMadeWhereAnotherProcessWasKilledMakingIt) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "layers");
  write_text(folder.path() / ".sample.toml.999999999-0", "name = 'a");
  EXPECT_TRUE(SampleFolder::can_begin(folder.path()));
  EXPECT_NO_THROW(SampleFolder::create(folder.path(), example()));
  EXPECT_FALSE(SampleFolder::can_begin(folder.path()));
  EXPECT_THAT(names_in(folder.path()),
              testing::UnorderedElementsAre("layers", "rejected", "sample.toml"));
}

TEST(SampleFolder, IsNotBegunWhereLayersAreWithoutADescription) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "layers");
  write_text(folder.path() / "layers" / "000001.tif", "precious");
  EXPECT_FALSE(SampleFolder::can_begin(folder.path()));
  EXPECT_THROW(SampleFolder::create(folder.path(), example()), SampleError);
}

TEST(SampleFolder, RefusesAFolderThatIsThereAndNotEmpty) {
  const TemporaryFolder folder;
  write_text(folder.path() / "precious", "x");
  EXPECT_THAT(message_of<SampleError>([&] { SampleFolder::create(folder.path(), example()); }),
              AllOf(StartsWith(folder.path().string()), HasSubstr("not empty")));
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("precious"));
}

TEST(SampleFolder, RefusesADescriptionThatMakesNoSenseBeforeItMakesAnything) {
  const TemporaryFolder folder;
  SampleDescription description = example();
  description.cuboid.spacing.z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SampleFolder::create(folder.path() / "knee", description), SampleError);
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(SampleFolder, ThatIsNotThereIsSaidSo) {
  EXPECT_THAT(message_of<SampleError>([] { SampleFolder::open("/nowhere/knee"); }),
              StartsWith("/nowhere/knee: there is no such sample"));
}

TEST_F(SampleToml, IsReadAsPeopleWriteIt) {
  EXPECT_EQ(message_for(good_toml()), "nothing was thrown");
}

TEST_F(SampleToml, RefusesUnknownKeys) {
  EXPECT_THAT(message_for("colour = 1\n" + good_toml()), HasSubstr("unknown key colour"));
  EXPECT_THAT(message_for(good_toml() + "w = 1\n"), HasSubstr("unknown key spacing_um.w"));
}

TEST_F(SampleToml, NamesWhatIsMissingOrOfTheWrongType) {
  EXPECT_THAT(message_for(replaced(good_toml(), "layers = 3\n", "")),
              HasSubstr("grid.layers is missing"));
  EXPECT_THAT(message_for(replaced(good_toml(), "width = 4", "width = 'wide'")),
              HasSubstr("grid.width is not of the right type"));
  EXPECT_THAT(message_for("name = 'a'\n"), HasSubstr("[grid] is missing"));
}

TEST_F(SampleToml, RefusesNumbersThatMakeNoSense) {
  EXPECT_THAT(message_for(replaced(good_toml(), "layers = 3", "layers = 0")),
              HasSubstr("grid.layers is 0"));
  EXPECT_THAT(message_for(replaced(good_toml(), "bits = 8", "bits = 12")), HasSubstr("bits is 12"));
  EXPECT_THAT(message_for(replaced(good_toml(), "z = 3", "z = -3")), HasSubstr("spacing_um.z"));
  EXPECT_THAT(message_for(replaced(good_toml(), "z = 3", "z = inf")), HasSubstr("spacing_um.z"));
}

TEST_F(SampleToml, RefusesRepeatedLayersThatThereCannotBe) {
  EXPECT_EQ(message_for("repeated_layers = [2, 3]\n" + good_toml()), "nothing was thrown");
  for (const char* layers : {"[1]", "[4]", "[3, 2]", "[2, 2]"}) {
    EXPECT_THAT(message_for("repeated_layers = " + std::string(layers) + "\n" + good_toml()),
                HasSubstr("repeated_layers must be"))
        << layers;
  }
  for (const char* layers : {"2", "['2']", "[2.5]"}) {
    EXPECT_THAT(message_for("repeated_layers = " + std::string(layers) + "\n" + good_toml()),
                HasSubstr("repeated_layers is not of the right type"))
        << layers;
  }
}

TEST_F(SampleToml, NamesTheLineThatIsNotToml) {
  EXPECT_THAT(message_for("name = 'a'\nnotes =\n"), HasSubstr("line 2"));
}

TEST_F(SampleToml, RefusesSpacingsBeyondAllSamples) {
  EXPECT_THAT(message_for(replaced(good_toml(), "z = 3", "z = 1e300")), HasSubstr("spacing_um.z"));
  EXPECT_THAT(message_for(replaced(good_toml(), "z = 3", "z = 1e-9")), HasSubstr("spacing_um.z"));
}

TEST_F(SampleToml, AnswersInOneLineOfReadableLengthWhateverItReads) {
  const std::string long_key(100'000, 'k');
  std::string nested = "a = ";
  nested.append(100'000, '[');
  for (const std::string& text :
       {long_key + " = 1\n" + good_toml(), "\"a\\nb\" = 1\n" + good_toml(), nested,
        "name = \"" + long_key + "\n" + good_toml()}) {
    const std::string message = message_for(text);
    EXPECT_THAT(message, testing::Not(HasSubstr("\n")));
    EXPECT_LT(message.size(), 400U);
  }
}

TEST_F(SampleToml, RefusesMoreThanADescriptionHolds) {
  EXPECT_THAT(message_for(good_toml() + std::string(2 << 20, '\n')),
              HasSubstr("no description of a sample"));
}

}  // namespace
}  // namespace biotomy::reconstruct
