#include <string>

#include "reconstruct/store/zarr_array.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {

bool fuzz_array_metadata(FuzzInput input) {
  const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
  return accepts("v/0/zarr.json", [&] {
    const auto array = reconstruct::parse_array_metadata(text, "v/0/zarr.json");
    require(reconstruct::parse_array_metadata(reconstruct::array_metadata(array), "again") == array,
            "an array that was read is written as another");
    require(reconstruct::shards_of(array).total() > 0, "the number of shards overflows");
    require(reconstruct::chunks_of_shard(array.layout).total() <= 1 << 20,
            "a shard's index needs more memory than it may");
  });
}

}  // namespace biotomy::tests
