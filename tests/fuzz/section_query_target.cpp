#include <string>

#include "acquisition/http/request_target.hpp"
#include "acquisition/viewer/section_query.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/refusal.hpp"

namespace biotomy::tests {

bool fuzz_section_query(FuzzInput input) {
  using namespace acquisition;
  const std::string text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto target = parse_target("/api/v1/section?" + text);
  if (!target) return false;
  const reconstruct::Cuboid cuboid{{100, 80, 60}, {10, 10, 20}};
  return accepts("", [&] {
    const SectionQuery query = section_query(target->query);
    section_request(query, cuboid);
    format_of(query.format);
    const std::string command = section_command(fitted(query, cuboid, 8), "/a sample's/folder");
    require(command.find('\n') == std::string::npos || text.find("%0") != std::string::npos ||
                text.find('\n') != std::string::npos,
            "a command has lines of its own");
  });
}

}  // namespace biotomy::tests
