#include <string>

#include "acquisition/http/request_target.hpp"
#include "acquisition/viewer/series_query.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {

bool fuzz_series_query(FuzzInput input) {
  using namespace acquisition;
  const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto target = parse_target("/api/v1/series/frames?" + text);
  if (!target) return false;
  const reconstruct::Cuboid cuboid{{100, 80, 60}, {10, 10, 20}};
  return accepts("", [&] {
    const SeriesQuery query = series_query(target->query);
    series_of(query, cuboid);
    style_of(query, cuboid);
    series_command(query, "/a sample's/folder");
  });
}

}  // namespace biotomy::tests
