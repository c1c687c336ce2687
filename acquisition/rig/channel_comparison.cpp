#include "acquisition/rig/channel_comparison.hpp"

#include <utility>

namespace biotomy::acquisition {
namespace {

/// A line holds danger for as long as its contact bounces, and the controller has a cycle of its
/// own.
constexpr std::chrono::seconds kSoon{2};

}  // namespace

void ChannelComparison::Switch::observe(bool by_controller, bool by_line, TimePoint now) {
  if (by_controller == by_line) {
    since.reset();
    is_told = false;
    return;
  }
  if (!since || line_sees_it != by_line) since = now;
  line_sees_it = by_line;
}

void ChannelComparison::observe(const bridge::Interlocks& by_controller,
                                const bridge::SafetyInputs& by_lines, TimePoint now) {
  now_ = now;
  if (!by_lines.failure.empty()) return;
  estop_.observe(by_controller.estop_pressed, by_lines.estop_pressed, now);
  door_.observe(by_controller.door_open, by_lines.door_open, now);
}

std::optional<std::string> ChannelComparison::take_disagreement() {
  for (const auto& [contact, name] :
       {std::pair{&estop_, "the e-stop pressed"}, std::pair{&door_, "the door open"}}) {
    if (!contact->since || now_ - *contact->since < kSoon) continue;
    if (std::exchange(contact->is_told, true)) continue;
    return std::string("only the ") + (contact->line_sees_it ? "line" : "controller") + " sees " +
           name + ": the " + (contact->line_sees_it ? "controller's" : "line's") +
           " contact is dead or badly wired, mend it";
  }
  return std::nullopt;
}

}  // namespace biotomy::acquisition
