#include "tests/bench/chunk_ranges.hpp"

#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/shard.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/whole_shard.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::bench {
namespace {

using reconstruct::SampleError;
using reconstruct::ZarrArray;
using testing::HasSubstr;
using testing::SizeIs;
using Bytes = std::vector<std::byte>;

/// One level of 4 x 1 x 1 chunks along x, two in a shard; the second shard holds its last alone.
class ShardsOnDisk : public testing::Test {
 protected:
  ShardsOnDisk() {
    array_.size = {32, 8, 8};
    array_.layout.chunk = {8, 8, 8};
    array_.layout.shard = {8, 8, 16};
    write(0, {Bytes(10), Bytes(20)});
    write(1, {Bytes(), Bytes(30)});
  }

  std::filesystem::path shard(std::int64_t x) const {
    return folder_.path() / reconstruct::shard_key(0, 0, x);
  }
  void write(std::int64_t x, const std::vector<Bytes>& chunks) const {
    std::filesystem::create_directories(shard(x).parent_path());
    reconstruct::write_file(shard(x), reconstruct::whole_shard(chunks));
  }

  tests::TemporaryFolder folder_;
  ZarrArray array_;
};

TEST_F(ShardsOnDisk, GiveTheRangesOfTheAskedChunks) {
  const ChunkRanges found = find_chunks(folder_.path(), array_, {{0, 0, 1}, {0, 0, 3}});
  ASSERT_THAT(found.chunks, SizeIs(2));
  ASSERT_THAT(found.files, SizeIs(2));
  EXPECT_EQ(found.chunks[0].offset, 10U);
  EXPECT_EQ(found.chunks[0].length, 20U);
  EXPECT_EQ(found.files[found.chunks[1].file], shard(1));
  EXPECT_EQ(found.bytes(), 50U);
}

TEST_F(ShardsOnDisk, LeaveOutWhatIsNotStored) {
  EXPECT_THAT(find_chunks(folder_.path(), array_, {{0, 0, 2}}).chunks, SizeIs(0));
  std::filesystem::remove(shard(0));
  EXPECT_THAT(find_chunks(folder_.path(), array_, {{0, 0, 0}, {0, 0, 1}}).files, SizeIs(0));
}

TEST_F(ShardsOnDisk, AreNamedWhenDamaged) {
  reconstruct::truncate_file(shard(0), 0.1);
  try {
    find_chunks(folder_.path(), array_, {{0, 0, 0}});
    FAIL();
  } catch (const SampleError& error) {
    EXPECT_THAT(error.what(), HasSubstr(shard(0).string()));
  }
  reconstruct::flip_byte(shard(1), 35);
  EXPECT_THROW(find_chunks(folder_.path(), array_, {{0, 0, 3}}), SampleError);
}

}  // namespace
}  // namespace biotomy::bench
