#include "tools/plane_options.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "reconstruct/errors.hpp"

namespace biotomy::tools {
namespace {

constexpr const char* kPoints = "--points";

bool may_be_a_point(const std::string& word) {
  return word.find(',') != std::string::npos &&
         word.find_first_not_of("0123456789+-.,eE ") == std::string::npos;
}

}  // namespace

void add_plane_options(CLI::App& command, reconstruct::PlaneText& plane) {
  command.allow_extras();
  command.add_option(kPoints, plane.points, "Three points of the plane, \"x,y,z x,y,z x,y,z\"");
  command.add_option("--normal", plane.normal,
                     "A normal of the plane, a,b,c: a direction in space, whatever the unit");
  command.add_option("--through", plane.through, "A point of the plane, x,y,z");
}

// An option of up to three arguments would take the sample's name for one of them where that comes
// after it.
void take_unquoted_points(CLI::App& command) {
  const std::vector<std::string> unknown = command.remaining();
  if (unknown.empty()) {
    return;
  }
  std::string words;
  for (const std::string& word : unknown) {
    words += ' ' + word;
  }
  CLI::Option* points = command.get_option(kPoints);
  const bool with_points = points->count() > 0;
  if (with_points && std::all_of(unknown.begin(), unknown.end(), may_be_a_point)) {
    const std::string joined = points->results().front() + words;
    points->clear();
    points->add_result(joined);
    points->run_callback();
    return;
  }
  const bool torn = with_points && std::any_of(unknown.begin(), unknown.end(), may_be_a_point);
  throw reconstruct::InvalidRequest(
      "The following arguments were not expected:" + words +
      (torn ? "; put the three points into quotes: --points \"x,y,z x,y,z x,y,z\"" : ""));
}

}  // namespace biotomy::tools
