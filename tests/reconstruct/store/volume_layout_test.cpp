#include "reconstruct/store/volume_layout.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::reconstruct {
namespace {

TEST(VolumeLayout, TheDefaultIsGood) {
  EXPECT_NO_THROW(check_layout({}));
}

TEST(VolumeLayout, RefusesAShardThatIsNoMultipleOfTheChunk) {
  VolumeLayout layout;
  layout.shard = {32, 1000, 1024};
  EXPECT_THAT(message_of<InvalidRequest>([&] { check_layout(layout); }),
              testing::HasSubstr("shard 1024,1000,32 (x,y,z)"));
}

TEST(VolumeLayout, RefusesAChunkWithoutVoxels) {
  VolumeLayout layout;
  layout.chunk = {0, 32, 32};
  EXPECT_THROW(check_layout(layout), InvalidRequest);
}

TEST(VolumeLayout, RefusesAChunkThatIsTooLargeForMemory) {
  VolumeLayout layout;
  layout.chunk = {1024, 1024, 1024};
  layout.shard = layout.chunk;
  EXPECT_THROW(check_layout(layout), InvalidRequest);
}

TEST(VolumeLayout, RefusesAnUnknownCodec) {
  VolumeLayout layout;
  layout.codec = "zip";
  EXPECT_THROW(check_layout(layout), InvalidRequest);
}

TEST(VolumeLayout, RefusesAShardOfTooManyChunks) {
  VolumeLayout layout;
  layout.chunk = {1, 1, 1};
  layout.shard = {1, 1024, 1024};
  EXPECT_NO_THROW(check_layout(layout));
  layout.shard = {2, 1024, 1024};
  EXPECT_THAT(message_of<InvalidRequest>([&] { check_layout(layout); }),
              testing::HasSubstr("1048576 chunks"));
}

}  // namespace
}  // namespace biotomy::reconstruct
