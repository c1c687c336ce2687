#include "acquisition/job/recovery.hpp"

#include <cmath>
#include <sstream>

namespace biotomy::acquisition {
namespace {

class Comparison {
 public:
  Comparison(const JobPlan& plan, const JournalSummary& journal,
             const bridge::StageStatus& controller, const SafetyLimits& limits)
      : plan_(plan), journal_(journal), controller_(controller), limits_(limits) {}

  std::variant<Continuation, Disagreement> run() const {
    if (journal_.last_committed > plan_.layers) {
      return disagreement() << "the journal has " << journal_.last_committed
                            << " committed layers and the job only " << plan_.layers
                            << ": it is another sample";
    }
    if (!journal_.last_grind) return without_a_grind();
    return after(*journal_.last_grind);
  }

 private:
  /// A sentence under construction that becomes the answer.
  class Sentence {
   public:
    template <typename Value>
    Sentence&& operator<<(const Value& value) && {
      text_ << value;
      return std::move(*this);
    }
    operator std::variant<Continuation, Disagreement>() && { return Disagreement{text_.str()}; }

   private:
    std::ostringstream text_;
  };

  static Sentence disagreement() { return {}; }

  bool at(bridge::Micrometres actual, bridge::Micrometres expected) const {
    return std::abs((actual - expected).value) <= limits_.position_tolerance.value;
  }

  std::variant<Continuation, Disagreement> without_a_grind() const {
    if (journal_.last_committed != 0) {
      return disagreement() << "the journal has layer " << journal_.last_committed
                            << " committed but no grind pass written down: it is damaged";
    }
    const bridge::Micrometres first = plan_.face_of(1);
    if (controller_.ground_to > first + limits_.position_tolerance) {
      return disagreement() << "the controller has ground to " << controller_.ground_to.value
                            << " µm, deeper than layer 1 at " << first.value
                            << " µm: set first_face_um to that or more (feed grows into the "
                               "block), or, with a new block, reset the controller's ground "
                               "position";
    }
    return Continuation{.layer = 1, .ground = false, .finished_grind = std::nullopt};
  }

  std::variant<Continuation, Disagreement> after(const GrindRow& grind) const {
    const std::int64_t n = journal_.last_committed;
    if (grind.layer != n && grind.layer != n + 1) {
      return disagreement() << "the journal's last grind pass was for layer " << grind.layer
                            << " but its last committed layer is " << n << ": it is damaged";
    }
    if (!at(grind.target, plan_.face_of(grind.layer))) {
      return disagreement() << "the journal ground layer " << grind.layer << " to "
                            << grind.target.value << " µm and the configuration puts it at "
                            << plan_.face_of(grind.layer).value
                            << " µm: first_face_um or layer_thickness_um was changed";
    }
    const std::int64_t passes =
        static_cast<std::int64_t>(controller_.grind_count) - grind.count_before;
    const bool finished = passes == 1 && at(controller_.ground_to, grind.target);
    const bool not_finished = passes == 0 && at(controller_.ground_to, grind.ground_before);
    if (finished) {
      return Continuation{
          .layer = n + 1,
          .ground = grind.layer == n + 1,
          .finished_grind = grind.finished ? std::nullopt : std::optional(grind.sequence)};
    }
    if (not_finished && !grind.finished && grind.layer == n + 1) {
      return Continuation{.layer = n + 1, .ground = false, .finished_grind = std::nullopt};
    }
    return disagreement() << "the journal's last grind pass (command " << grind.sequence
                          << ", layer " << grind.layer << " to " << grind.target.value << " µm, "
                          << (grind.finished ? "finished" : "end unknown")
                          << ") disagrees with the controller, which counts " << passes
                          << " passes since and has ground to " << controller_.ground_to.value
                          << " µm: look at the block before anything moves";
  }

  const JobPlan& plan_;
  const JournalSummary& journal_;
  const bridge::StageStatus& controller_;
  const SafetyLimits& limits_;
};

}  // namespace

std::variant<Continuation, Disagreement> where_to_go_on(const JobPlan& plan,
                                                        const JournalSummary& journal,
                                                        const bridge::StageStatus& controller,
                                                        const SafetyLimits& limits) {
  return Comparison(plan, journal, controller, limits).run();
}

}  // namespace biotomy::acquisition
