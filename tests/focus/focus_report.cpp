// Runs the autofocus over the courses and prints what came of it as a Markdown table. Exit status:
// 0 every goal was reached, 1 one was missed, 2 wrong usage.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/focus/focus_course.hpp"

namespace biotomy::tests {

namespace {

constexpr double kGoal = 0.995;        ///< of the layers, within a quarter of the depth of field
constexpr double kRunAwayUm = 1200.0;  ///< the reach, and the guess's error

struct Row {
  int layers = 0;
  int within = 0;
  int searches = 0;
  int found = 0;
  int frames = 0;
  int taken_again = 0;
  int most_frames = 0;
  double farthest_um = 0.0;
  double worst_um = 0.0;
  double squares = 0.0;

  void add(const FocusOutcome& outcome) {
    const double limit_um = 0.25 * course_depth_of_field_um();
    for (const double miss_um : outcome.misses_um) {
      ++layers;
      within += std::abs(miss_um) <= limit_um ? 1 : 0;
      worst_um = std::max(worst_um, std::abs(miss_um));
      squares += miss_um * miss_um;
    }
    searches += outcome.searches;
    found += outcome.found;
    frames += outcome.focus_frames;
    taken_again += outcome.taken_again;
    most_frames = std::max(most_frames, outcome.most_frames);
    farthest_um = std::max(farthest_um, outcome.farthest_um);
  }

  void print(const std::string& name) const {
    std::printf("| %s | %d | %.2f %% | %.1f | %.1f | %d of %d | %.2f | %d | %d | %.0f |\n",
                name.c_str(), layers, 100.0 * within / layers, std::sqrt(squares / layers),
                worst_um, found, searches, static_cast<double>(frames) / layers, taken_again,
                most_frames, farthest_um);
  }
};

int report(int layers) {
  std::printf(
      "| course | layers | within %.1f µm | RMS, µm | worst, µm | searches found | "
      "frames a layer | taken again | most in a search | farthest, µm |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
      0.25 * course_depth_of_field_um());
  Row all;
  for (FocusCourse course : focus_courses()) {
    course.layers = layers;
    const FocusOutcome outcome = run(course);
    Row row;
    row.add(outcome);
    row.print(outcome.name);
    all.add(outcome);
  }
  all.print("all");
  const bool is_sharp = all.within >= kGoal * all.layers;
  const bool is_tame = all.farthest_um <= kRunAwayUm;
  std::printf(
      "\n- within a quarter of the depth of field in at least 99.5 %% of the layers: %s\n"
      "- no run-away: %s\n",
      is_sharp ? "met" : "**missed**", is_tame ? "met" : "**missed**");
  return is_sharp && is_tame ? 0 : 1;
}

}  // namespace

}  // namespace biotomy::tests

int main(int count, char** arguments) {
  constexpr int kLayers = 200;
  const int layers = count > 1 ? std::atoi(arguments[1]) : kLayers;
  if (count > 2 || layers < 1) {
    std::fputs("usage: focus_report [LAYERS of each course, 200]\n", stderr);
    return 2;
  }
  return biotomy::tests::report(layers);
}
