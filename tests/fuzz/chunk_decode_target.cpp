#include <vector>

#include "reconstruct/store/codecs.hpp"
#include "tests/fuzz/chunk_kinds.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"
#include "tests/fuzz/with_checksum.hpp"

namespace biotomy::tests {

bool fuzz_chunk_decode(FuzzInput input) {
  if (input.empty()) return false;
  static const std::vector<ChunkKind> kKinds = chunk_kinds();
  const ChunkKind& kind = kKinds[std::to_integer<std::size_t>(input[0]) % kKinds.size()];
  const reconstruct::ChunkCodec codec(kind.layout, kind.bits);
  std::vector<std::byte> voxels(codec.chunk_bytes());
  accepts("", [&] { codec.decode(input.subspan(1), voxels); });
  return accepts("", [&] {
    codec.decode(with_checksum(input.subspan(1)), voxels);
    std::vector<std::byte> again(codec.chunk_bytes());
    codec.decode(codec.encode(voxels), again);
    require(again == voxels, "a decoded chunk is not encoded as what it is");
  });
}

}  // namespace biotomy::tests
