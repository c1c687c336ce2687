#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/focus/focus_bracket.hpp"
#include "acquisition/focus/focus_settings.hpp"
#include "acquisition/quality/camera_noise.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Where a search for the focus begins and how far it may go.
struct SearchPlan {
  bridge::Micrometres predicted{};
  bridge::Micrometres step{};  ///< of the first bracket
  /// A peak farther than this from the predicted position is not believed; none: it may lie
  /// anywhere within FocusSettings::reach.
  std::optional<bridge::Micrometres> largest_change;
  std::optional<CameraNoise> noise{};  ///< by which frames are measured, where it is known
};

/// Looks for the position of greatest detail. A bracket of `points` positions around the predicted
/// one, and a parabola through the logarithm of their detail. When the peak is not inside, the
/// bracket moves towards it, with twice the step from the second time on; when it is flat, the step
/// grows; when a wide bracket has found the peak, finer ones follow. At last a fresh frame at the
/// peak confirms that it is no worse than the best of the bracket.
///
/// Positions are approached from below, so that the backlash is always taken up on the same side.
/// It ends after 1 + `shifts` brackets, each with its confirmation, measures nowhere beyond `reach`
/// from the predicted position and goes nowhere beyond `limits`.
/// It only thinks: the caller moves to what `next` asks for and reports what it saw.
class Autofocus {
 public:
  struct Request {
    bridge::Micrometres position{};
    bool measure = false;  ///< false: only to take up the backlash
  };

  Autofocus(const FocusSettings& settings, const SearchPlan& plan, bridge::AxisLimits limits);

  /// Where to go now; nothing when the search has ended.
  std::optional<Request> next() const;

  void arrived();                                             ///< answers what does not measure
  void measured(std::shared_ptr<const FrameMeasures> frame);  ///< answers what measures

  /// Ends the search without a focus, for a reason that the caller has.
  void give_up(const std::string& why);

  struct Found {
    bridge::Micrometres position{};  ///< where the last frame, which confirmed it, was taken
    /// Of the bracket that would suit this curve: its ends lose a quarter of the energy, enough to
    /// tell from noise and little enough for a parabola.
    bridge::Micrometres step{};
    std::shared_ptr<const FrameMeasures> measures;  ///< of the frame that confirmed it
    std::optional<FocusMap> map;
  };

  /// After the end.
  const std::optional<Found>& found() const { return found_; }
  const std::string& why_not() const { return why_not_; }

 private:
  struct Candidate {
    BracketVerdict verdict;
    bridge::Micrometres step{};
  };

  void begin_bracket(bridge::Micrometres centre, bridge::Micrometres step);
  void end_bracket();
  void took_a_peak(const BracketVerdict& verdict);
  void move_on(const BracketVerdict& verdict);
  void widen(const BracketVerdict& verdict);
  void confirm();
  void end_confirmation(std::shared_ptr<const FrameMeasures> frame);
  void out_of_brackets(const std::string& why);

  FocusSettings settings_;
  SearchPlan plan_;
  bridge::AxisLimits limits_;
  bridge::AxisLimits window_;
  int brackets_left_;
  bridge::Micrometres first_{};  ///< of the bracket
  bridge::Micrometres step_{};
  bool approached_ = false;
  bool confirming_ = false;
  bool ended_ = false;
  std::vector<BracketFrame> bracket_;
  std::optional<Candidate> candidate_;
  std::optional<BracketVerdict::Kind> last_kind_;
  std::optional<Found> found_;
  std::string why_not_;
};

}  // namespace biotomy::acquisition
