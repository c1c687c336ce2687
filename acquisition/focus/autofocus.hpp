#pragma once

#include <optional>
#include <vector>

#include "firmware_bridge/micrometres.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

struct FocusSettings {
  bridge::Micrometres start{};         ///< where the first search of a sample begins
  int points = 11;                     ///< of a sweep
  bridge::Micrometres step{20.0};      ///< between them
  int shifts = 8;                      ///< a sweep with its peak at the rim moves on so often
  bridge::Micrometres backlash{50.0};  ///< every position is approached from below by so much
  int every_layers = 10;               ///< a search at the latest after so many layers
  double search_below_ratio = 0.95;    ///< and when the sharpness fell below this part of the peak
};

/// Looks for the camera column's position of greatest sharpness: a sweep of `points` positions
/// around the predicted one, in growing order so that the backlash is always taken up on the same
/// side, and a parabola through the peak and its neighbours. When the peak lies at the rim of the
/// sweep, the sweep is repeated around that rim.
/// It only thinks: the caller moves the column to what `next` asks for and reports what it saw.
class Autofocus {
 public:
  struct Request {
    bridge::Micrometres column{};
    bool measure = false;  ///< false: only to take up the backlash
  };
  struct Point {
    bridge::Micrometres column{};
    double sharpness = 0.0;
  };

  /// The sweep stays inside `column`.
  Autofocus(const FocusSettings& settings, bridge::Micrometres predicted,
            bridge::AxisLimits column);

  /// Where the column is to go now; nothing when the search has ended.
  std::optional<Request> next() const;

  void arrived();                   ///< answers a request that does not measure
  void measured(double sharpness);  ///< answers a request that measures

  /// After the end: the best position; nothing when no peak was found.
  std::optional<Point> best() const { return best_; }

  /// Everything that was measured, in its order.
  const std::vector<Point>& points() const { return points_; }

 private:
  void begin_sweep(bridge::Micrometres centre);
  void end_sweep();

  FocusSettings settings_;
  bridge::AxisLimits column_;
  bridge::Micrometres first_{};  ///< of the sweep
  int measured_ = 0;             ///< in this sweep
  int shifts_left_;
  bool approached_ = false;
  bool ended_ = false;
  std::vector<Point> points_;
  std::optional<Point> best_;
};

/// The vertex of the parabola through three points at equal distances `step`, the middle one the
/// highest. Its offset from the middle is at most half a step.
Autofocus::Point parabola_peak(Autofocus::Point left, Autofocus::Point middle,
                               Autofocus::Point right);

}  // namespace biotomy::acquisition
