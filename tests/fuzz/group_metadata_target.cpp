#include <string>

#include "reconstruct/store/ome_metadata.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {

bool fuzz_group_metadata(FuzzInput input) {
  const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
  return accepts("v/zarr.json", [&] {
    const auto metadata = reconstruct::parse_group_metadata(text, "v/zarr.json");
    require(
        reconstruct::parse_group_metadata(reconstruct::group_metadata(metadata), "again").levels ==
            metadata.levels,
        "levels that were read are written as others");
  });
}

}  // namespace biotomy::tests
