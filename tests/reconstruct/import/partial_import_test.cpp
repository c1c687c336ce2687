#include "reconstruct/import/partial_import.hpp"

#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/inotify.h>
#include <unistd.h>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/import/import_request.hpp"
#include "reconstruct/sample/layer_hashes.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHash(64, 'a');

/// What goes from some folders, in its order.
class Removals {
 public:
  explicit Removals(const std::vector<std::filesystem::path>& folders)
      : watch_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
    for (const auto& folder : folders) {
      ::inotify_add_watch(watch_.get(), folder.c_str(), IN_DELETE);
    }
  }

  std::string first() {
    alignas(inotify_event) std::array<char, 4096> events{};
    if (::read(watch_.get(), events.data(), events.size()) <= 0) {
      return "nothing";
    }
    return reinterpret_cast<const inotify_event*>(events.data())->name;
  }

 private:
  FileDescriptor watch_;
};

class APartialImport : public testing::Test {
 protected:
  APartialImport() {
    std::filesystem::create_directory(folder_ / "out");
    for (int i = 1; i <= 2; ++i) {
      save_rgb(folder_ / (std::to_string(i) + ".png"), test_image(8, 6));
    }
    request_.name = "knee";
    request_.scale = VoxelSpacing{{1, 2, 3}};
    description_.name = "knee";
    description_.cuboid = {{8, 6, 2}, {1, 2, 3}};
  }
  nlohmann::json asked() const {
    return import_record(ImageSequence::find({folder_.path()}), request_);
  }
  /// As if the layer's image were stored.
  static void store(PartialImport&& partial, std::int64_t layer) { store(partial, layer); }
  static void store(PartialImport& partial, std::int64_t layer) {
    write_text(partial.sample().layer_path(layer), "an image");
    partial.add_stored(layer, kHash);
  }
  PartialImport take(bool restart = false) const {
    return {output_, description_, asked(), restart};
  }
  std::string refusal() const {
    return message_of<SampleError>([&] { take(); });
  }
  auto names() const { return names_in(folder_ / "out"); }

  tests::TemporaryFolder folder_;
  std::filesystem::path output_ = folder_ / "out" / "knee";
  ImportRequest request_;
  SampleDescription description_;
};

TEST_F(APartialImport, RemembersTheLayersThatAreStored) {
  {
    PartialImport partial = take();
    EXPECT_EQ(partial.stored_layers(), 0);
    store(partial, 2);
  }
  const PartialImport again = take();
  EXPECT_EQ(again.stored_layers(), 1);
  EXPECT_TRUE(again.is_stored(2));
  EXPECT_FALSE(again.is_stored(1));
  EXPECT_THAT(names(), ElementsAre(".knee.partial"));
}

TEST_F(APartialImport, DoesNotCountALayerWhoseRecordWasCutOff) {
  store(take(), 1);
  const auto hashes = folder_ / "out" / ".knee.partial" / "layers.sha256";
  const auto size = std::filesystem::file_size(hashes);
  std::filesystem::resize_file(hashes, size - 3);
  {
    PartialImport again = take();
    EXPECT_EQ(again.stored_layers(), 0);
    store(again, 1);
  }
  EXPECT_EQ(std::filesystem::file_size(hashes), size);
  EXPECT_EQ(take().stored_layers(), 1);
}

// On a full disk one record may be cut off and another, which was on its way, come behind it.
TEST_F(APartialImport, DropsRecordsThatCannotBeRead) {
  store(take(), 2);
  const auto hashes = folder_ / "out" / ".knee.partial" / "layers.sha256";
  write_text(hashes, kHash.substr(0, 20) + kHash + "  layers/000001.tif\n" + kHash +
                         "  layers/000002.tif\n");
  const PartialImport again = take();
  EXPECT_FALSE(again.is_stored(1));
  EXPECT_TRUE(again.is_stored(2));
  EXPECT_EQ(read_layer_hashes(hashes).size(), 1U);
}

TEST_F(APartialImport, DoesNotCountALayerWhoseFileACrashTookAway) {
  store(take(), 1);
  std::filesystem::remove(folder_ / "out" / ".knee.partial" / "sample" / "layers" / "000001.tif");
  EXPECT_EQ(take().stored_layers(), 0);
}

TEST_F(APartialImport, BecomesTheOutputWithTheHashesInOrder) {
  PartialImport partial = take();
  store(partial, 2);
  store(partial, 1);
  EXPECT_EQ(partial.finish(), output_);
  EXPECT_THAT(names(), ElementsAre("knee"));
  const auto hashes = read_file(output_ / "layers.sha256");
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(hashes.data()), hashes.size()),
            kHash + "  layers/000001.tif\n" + kHash + "  layers/000002.tif\n");
}

TEST_F(APartialImport, KeepsASecondOneAwayWhileItIsAtWork) {
  const PartialImport partial = take();
  EXPECT_THAT(refusal(), HasSubstr("another import"));
  EXPECT_THAT(message_of<SampleError>([&] { take(true); }), HasSubstr("another import"));
}

TEST_F(APartialImport, DoesNotMindAnImageThatWasMendedBeforeItsLayerWasStored) {
  store(take(), 1);
  save_rgb(folder_ / "2.png", test_image(8, 6, CV_8UC3, 5));
  EXPECT_EQ(take().stored_layers(), 1);
  save_rgb(folder_ / "1.png", test_image(8, 6, CV_8UC3, 6));
  EXPECT_THAT(refusal(), HasSubstr("1.png"));
}

TEST_F(APartialImport, TellsInWhatAnotherRequestDiffersAndOffersToBeginAnew) {
  store(take(), 1);
  const ImportRequest begun = request_;
  request_.scale = VoxelSpacing{{1, 2, 4}};
  EXPECT_THAT(refusal(), AllOf(HasSubstr("spacing"), HasSubstr("--restart")));
  request_ = begun;
  request_.scale = StackSize{{1, 2, 3}};
  EXPECT_THAT(refusal(), HasSubstr("spacing"));
  request_ = begun;
  request_.layout.codec = "raw";
  EXPECT_THAT(refusal(), HasSubstr("layout"));
  request_ = begun;
  request_.notes = "x";
  EXPECT_THAT(refusal(), HasSubstr("notes"));
  request_ = begun;
  request_.layer_format.compression = LayerCompression::deflate;
  EXPECT_THAT(refusal(), HasSubstr("compression"));
  request_ = begun;
  save_rgb(folder_ / "1.png", test_image(8, 6, CV_8UC3, 5));
  EXPECT_THAT(refusal(), HasSubstr("1.png"));
  save_rgb(folder_ / "3.png", test_image(8, 6));
  EXPECT_THAT(refusal(), HasSubstr("number of images"));
  EXPECT_EQ(take(true).stored_layers(), 0);
}

TEST_F(APartialImport, BeginsAnewWithOtherImagesWhereNoLayerIsStoredYet) {
  take();
  request_.notes = "x";
  description_.cuboid.size = {9, 6, 2};
  description_.bits = 16;
  const PartialImport partial = take();
  EXPECT_EQ(partial.sample().description().cuboid.size.x, 9);
  EXPECT_EQ(partial.sample().description().bits, 16);
}

TEST_F(APartialImport, PutsNoLayersOfAnotherSizeOrDepthBesideThoseThatAreStored) {
  store(take(), 2);
  const SampleDescription begun = description_;
  description_.cuboid.size = {9, 6, 2};
  EXPECT_THAT(refusal(), AllOf(HasSubstr("the size"), HasSubstr("--restart")));
  description_ = begun;
  description_.bits = 16;
  EXPECT_THAT(refusal(), AllOf(HasSubstr("bits"), HasSubstr("--restart")));
  description_ = begun;
  EXPECT_EQ(take().stored_layers(), 1);
}

TEST_F(APartialImport, BegunAnewIsNoImportToTakeUpWhileTheFormerOneIsRemoved) {
  store(take(), 1);
  const auto partial = folder_ / "out" / ".knee.partial";
  Removals removals({partial, partial / "sample", partial / "sample" / "layers"});
  take(true);
  EXPECT_EQ(removals.first(), "request.json");
}

TEST_F(APartialImport, RemovesFilesThatWereNotFinishedWhenItWasKilled) {
  store(take(), 1);
  const auto sample = folder_ / "out" / ".knee.partial" / "sample";
  std::filesystem::create_directories(sample / "volume.ome.zarr" / "0" / "c");
  write_text(sample / "layers" / ".000002.tif.999999999-3", "half");
  write_text(sample / "volume.ome.zarr" / "0" / "c" / ".0.999999999-4", "half");
  take();
  EXPECT_THAT(names_in(sample / "layers"), ElementsAre("000001.tif"));
  EXPECT_TRUE(names_in(sample / "volume.ome.zarr" / "0" / "c").empty());
}

TEST_F(APartialImport, DoesNotMindAnotherTimeOfBeginning) {
  store(take(), 1);
  request_.created = "2026-01-02T03:04:05Z";
  EXPECT_EQ(take().stored_layers(), 1);
}

TEST_F(APartialImport, BeginsWhereOneWasKilledBeforeItHadBegun) {
  std::filesystem::create_directories(folder_ / "out" / ".knee.partial" / "sample" / "layers");
  PartialImport partial = take();
  EXPECT_EQ(partial.stored_layers(), 0);
  EXPECT_EQ(partial.finish(), output_);
}

TEST_F(APartialImport, RefusesAnOutputThatIsThereAndRemovesWhatIsLeftOfItsImport) {
  take().finish();
  const auto left = folder_ / "out" / ".knee.partial";
  std::filesystem::create_directory(left);
  write_text(left / "request.json", "{}");
  EXPECT_THAT(refusal(), HasSubstr("not empty"));
  EXPECT_THAT(names(), ElementsAre("knee"));
}

TEST_F(APartialImport, IsTheSameForANameWithASlashAtItsEnd) {
  store(take(), 1);
  EXPECT_EQ(PartialImport(output_ / "", description_, asked(), false).stored_layers(), 1);
}

TEST_F(APartialImport, NamesARequestThatIsDamaged) {
  store(take(), 1);
  write_text(folder_ / "out" / ".knee.partial" / "request.json", "{");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("request.json"), HasSubstr("--restart")));
  write_text(folder_ / "out" / ".knee.partial" / "request.json", "[]");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("request.json"), HasSubstr("--restart")));
}

TEST_F(APartialImport, SaysHowToGoOnWhereItsSampleCannotBeOpened) {
  store(take(), 1);
  std::filesystem::remove(folder_ / "out" / ".knee.partial" / "sample" / "sample.toml");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("sample.toml"), HasSubstr("--restart")));
}

}  // namespace
}  // namespace biotomy::reconstruct
