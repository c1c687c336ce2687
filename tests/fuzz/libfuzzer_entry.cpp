#include <cstddef>
#include <cstdint>

#include "tests/fuzz/fuzz_targets.hpp"

// BIOTOMY_FUZZ_TARGET is the function; what it throws ends the process, which libFuzzer reports.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  biotomy::tests::BIOTOMY_FUZZ_TARGET(std::as_bytes(std::span(data, size)));
  return 0;
}
