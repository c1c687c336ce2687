#include "reconstruct/store/metadata_text.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/local_object_reader.hpp"
#include "reconstruct/store/metadata_json.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class MetadataText : public testing::Test {
 protected:
  std::string error() const {
    return message_of<SampleError>([&] { read_metadata_file(path_); });
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / kMetadataName;
};

TEST_F(MetadataText, IsWhatTheFileHolds) {
  write_text(path_, "{}\n");
  LocalObjectReader objects(folder_.path());
  EXPECT_EQ(read_metadata_text(objects, kMetadataName), "{}\n");
  EXPECT_EQ(read_metadata_file(path_), "{}\n");
}

TEST_F(MetadataText, IsNoneWhereThereIsNoFileAndAnErrorWhereItMustBe) {
  LocalObjectReader objects(folder_.path());
  EXPECT_EQ(read_metadata_text(objects, kMetadataName), std::nullopt);
  EXPECT_THAT(error(), AllOf(StartsWith(path_.string()), HasSubstr("is missing")));
}

TEST_F(MetadataText, IsNotReadBeyondWhatMetadataHas) {
  write_text(path_, "{}");
  std::filesystem::resize_file(path_, kMostMetadataBytes);
  EXPECT_EQ(read_metadata_file(path_).size(), kMostMetadataBytes);
  std::filesystem::resize_file(path_, std::uintmax_t{1} << 40);  // holes alone
  EXPECT_THAT(error(), AllOf(StartsWith(path_.string()), HasSubstr("too large")));
}

TEST_F(MetadataText, IsNotWaitedForFromAPipe) {
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THAT(error(), AllOf(StartsWith(path_.string()), HasSubstr("is not a file")));
}

}  // namespace
}  // namespace biotomy::reconstruct
