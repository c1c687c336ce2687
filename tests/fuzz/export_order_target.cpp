#include <string>

#include "acquisition/viewer/exports/export_order.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {

bool fuzz_export_order(FuzzInput input) {
  using namespace acquisition;
  const std::string body(reinterpret_cast<const char*>(input.data()), input.size());
  return accepts("", [&] {
    const ExportOrder order = export_order(body);
    require(order.section.has_value() != order.series.has_value(), "is not of one kind");
    require(!order.series || order.frames || order.movie, "has nothing to export");
    require(order.rate >= 1.0 && order.rate <= 120.0, "has a rate beside its limits");
  });
}

}  // namespace biotomy::tests
