#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "reconstruct/store/shard.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"
#include "tests/fuzz/with_checksum.hpp"

namespace biotomy::tests {

bool fuzz_shard_index(FuzzInput input) {
  constexpr std::uint64_t kLongestChunk = 1 << 16;
  const std::vector<std::byte> bytes = with_checksum(input);
  bool taken = false;
  for (const std::uint64_t shard_bytes :
       {std::uint64_t{0}, std::uint64_t{4096}, std::uint64_t{1} << 40}) {
    taken |= accepts("", [&] {
      const auto index = reconstruct::parse_shard_index(bytes, shard_bytes, kLongestChunk);
      std::uint64_t stored = 0;
      for (const reconstruct::ChunkRange& range : index) {
        if (!range.stored()) continue;
        require(range.length <= kLongestChunk, "a chunk is longer than any");
        require(range.offset <= shard_bytes - bytes.size(), "a chunk begins after the shard");
        stored += range.length;
      }
      require(stored <= shard_bytes, "the chunks are longer than their shard");
    });
  }
  accepts("", [&] { reconstruct::parse_shard_index(input, 4096, kLongestChunk); });
  return taken;
}

}  // namespace biotomy::tests
