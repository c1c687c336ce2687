#include "reconstruct/store/stored_shard.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
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
    write_file(path_, encode_shard({{}, codec().encode(voxels_), {}, {}}));
  }
  ChunkCodec codec() const { return {layout_, 8}; }
  std::optional<StoredShard> read() const { return StoredShard::read(path_, {1, 2, 2}); }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "shard";
  VolumeLayout layout_;
  std::vector<std::byte> voxels_;
};

TEST_F(AStoredShard, GivesItsChunksAndFillValueForThoseThatItHasNot) {
  const auto shard = read();
  ASSERT_TRUE(shard);
  std::vector<std::byte> voxels(codec().chunk_bytes(), std::byte{1});
  shard->decode(0, codec(), voxels);
  EXPECT_THAT(voxels, testing::Each(std::byte{0}));
  shard->decode(1, codec(), voxels);
  EXPECT_EQ(voxels, voxels_);
  EXPECT_TRUE(shard->encoded(0).empty());
  EXPECT_FALSE(shard->encoded(1).empty());
}

TEST_F(AStoredShard, IsNoneWhereThereIsNoFile) {
  EXPECT_FALSE(StoredShard::read(folder_ / "nowhere" / "shard", {1, 2, 2}));
}

TEST_F(AStoredShard, NamesTheFileThatIsTruncatedOrWhoseIndexIsDamaged) {
  flip_byte(path_, std::filesystem::file_size(path_) - 10);
  EXPECT_THAT(message_of<SampleError>([&] { read(); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("index")));
  std::filesystem::resize_file(path_, 20);
  EXPECT_THAT(message_of<SampleError>([&] { read(); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("truncated")));
}

TEST_F(AStoredShard, NamesTheChunkThatIsDamaged) {
  flip_byte(path_, 3);
  std::vector<std::byte> voxels(codec().chunk_bytes());
  EXPECT_THAT(message_of<SampleError>([&] { read()->decode(1, codec(), voxels); }),
              AllOf(HasSubstr(path_.string()), HasSubstr("z 0, y 0, x 1"), HasSubstr("checksum")));
}

}  // namespace
}  // namespace biotomy::reconstruct
