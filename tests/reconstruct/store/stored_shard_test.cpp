#include "reconstruct/store/stored_shard.hpp"

#include <cstdint>
#include <fstream>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/whole_shard.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class AStoredShard : public testing::Test {
 protected:
  AStoredShard() {
    layout_.chunk = {2, 2, 2};
    layout_.shard = {2, 4, 4};
    layout_.codec = "zstd1";
    voxels_.assign(codec().chunk_bytes(), std::byte{7});
    write_file(path_, whole_shard({{}, codec().encode(voxels_), {}, {}}));
  }
  ChunkCodec codec() const { return {layout_, 8}; }
  std::optional<StoredShard> open() const { return StoredShard::open(path_, array()); }
  ZarrArray array() const { return {{4, 4, 2}, 8, layout_}; }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "shard";
  VolumeLayout layout_;
  std::vector<std::byte> voxels_;
};

TEST_F(AStoredShard, GivesItsChunksAndFillValueForThoseThatItHasNot) {
  const auto shard = open();
  ASSERT_TRUE(shard);
  std::vector<std::byte> voxels(codec().chunk_bytes(), std::byte{1});
  shard->decode(0, codec(), voxels);
  EXPECT_THAT(voxels, testing::Each(std::byte{0}));
  shard->decode(1, codec(), voxels);
  EXPECT_EQ(voxels, voxels_);
  EXPECT_FALSE(shard->stores(0));
  EXPECT_TRUE(shard->encoded(0).empty());
  EXPECT_TRUE(shard->stores(1));
  EXPECT_EQ(shard->encoded(1), codec().encode(voxels_));
}

TEST_F(AStoredShard, IsNoneWhereThereIsNoFile) {
  EXPECT_FALSE(StoredShard::open(folder_ / "nowhere" / "shard", array()));
}

TEST_F(AStoredShard, NamesTheFileThatIsTruncatedOrWhoseIndexIsDamaged) {
  flip_byte(path_, std::filesystem::file_size(path_) - 10);
  EXPECT_THAT(message_of<SampleError>([&] { open(); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("index")));
  std::filesystem::resize_file(path_, 20);
  EXPECT_THAT(message_of<SampleError>([&] { open(); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("truncated")));
}

TEST_F(AStoredShard, HoldsNoMoreThanItsIndexHoweverLongTheFileIs) {
  // A terabyte of holes in front of the same index.
  const auto whole = read_file(path_);
  const std::uint64_t index_at = std::uint64_t{1} << 40;
  std::filesystem::resize_file(path_, index_at);
  std::ofstream out(path_, std::ios::binary | std::ios::app);
  const std::size_t index_bytes = shard_index_bytes(4);
  out.write(reinterpret_cast<const char*>(whole.data() + whole.size() - index_bytes),
            static_cast<std::streamsize>(index_bytes));
  out.close();
  ASSERT_EQ(std::filesystem::file_size(path_), index_at + index_bytes);
  EXPECT_EQ(open()->encoded(1), codec().encode(voxels_));
}

TEST_F(AStoredShard, RefusesAChunkThatIsLongerThanAnyEncoderMakesIt) {
  write_file(path_,
             whole_shard({std::vector<std::byte>(codec().longest_encoded() + 1), {}, {}, {}}));
  EXPECT_THAT(message_of<SampleError>([&] { open(); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("more than any has")));
}

TEST_F(AStoredShard, NamesWhatIsNoFile) {
  std::filesystem::remove(path_);
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THAT(message_of<SampleError>([&] { open(); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("is not a file")));
}

TEST_F(AStoredShard, NamesTheChunkThatIsDamaged) {
  flip_byte(path_, 3);
  std::vector<std::byte> voxels(codec().chunk_bytes());
  EXPECT_THAT(message_of<SampleError>([&] { open()->decode(1, codec(), voxels); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("z 0, y 0, x 1"), HasSubstr("checksum")));
}

}  // namespace
}  // namespace biotomy::reconstruct
