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
  const std::vector<std::byte> encoded = with_checksum(input.subspan(1));
  const reconstruct::ChunkLayers some{kind.layout.chunk[0] / 4, kind.layout.chunk[0] / 2};
  std::vector<std::byte> room(codec.chunk_bytes());
  std::vector<std::byte> part;
  accepts("", [&] {
    const auto decoded = codec.decode_layers(encoded, some, room);
    const std::size_t layer = decoded.size() / static_cast<std::size_t>(kind.layout.chunk[0]);
    const auto bytes = decoded.subspan(static_cast<std::size_t>(some.first) * layer,
                                       static_cast<std::size_t>(some.end - some.first) * layer);
    part.assign(bytes.begin(), bytes.end());
  });
  return accepts("", [&] {
    codec.decode(encoded, voxels);
    const std::size_t layer = voxels.size() / static_cast<std::size_t>(kind.layout.chunk[0]);
    require(std::equal(part.begin(), part.end(),
                       voxels.begin() + static_cast<std::ptrdiff_t>(
                                            static_cast<std::size_t>(some.first) * layer)) &&
                part.size() == static_cast<std::size_t>(some.end - some.first) * layer,
            "some layers are decoded as others than with all");
    std::vector<std::byte> again(codec.chunk_bytes());
    codec.decode(codec.encode(voxels), again);
    require(again == voxels, "a decoded chunk is not encoded as what it is");
  });
}

}  // namespace biotomy::tests
