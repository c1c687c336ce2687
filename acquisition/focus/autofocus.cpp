#include "acquisition/focus/autofocus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace biotomy::acquisition {
namespace {

using Kind = BracketVerdict::Kind;

constexpr double kWider = 2.0;
constexpr double kFiner = 0.25;
constexpr double kFineEnough = 2.0;  ///< times the finest step

/// What the logarithm of the energy falls by at the ends of a bracket that suits the curve.
constexpr double kSuitableDrop = 0.3;

/// A frame may show less detail than the bracket's best by so many standard deviations …
constexpr double kConfirmed = 3.0;
/// … and by this part, for what the lamp and the air do between two frames.
constexpr double kConfirmedShare = 0.02;

std::string text(const char* format, double first, double second) {
  std::array<char, 200> line{};
  // NOLINTNEXTLINE(clang-diagnostic-format-nonliteral): made below, from literals
  std::snprintf(line.data(), line.size(), format, first, second);
  return line.data();
}

}  // namespace

Autofocus::Autofocus(const FocusSettings& settings, const SearchPlan& plan,
                     bridge::AxisLimits limits)
    : settings_(settings),
      plan_(plan),
      limits_(limits),
      window_{std::max(limits.minimum, plan.predicted - settings.reach),
              std::min(limits.maximum, plan.predicted + settings.reach)},
      brackets_left_(settings.shifts) {
  begin_bracket(plan.predicted, plan.step);
}

void Autofocus::begin_bracket(bridge::Micrometres centre, bridge::Micrometres step) {
  const double gaps = settings_.points - 1;
  step_ = std::min(step, (1.0 / gaps) * (window_.maximum - window_.minimum));
  const bridge::Micrometres span = gaps * step_;
  first_ = std::clamp(centre - 0.5 * span, window_.minimum, window_.maximum - span);
  bracket_.clear();
  approached_ = settings_.backlash.value <= 0.0;
  confirming_ = false;
}

std::optional<Autofocus::Request> Autofocus::next() const {
  if (ended_) return std::nullopt;
  const bridge::Micrometres aim = confirming_
                                      ? candidate_->verdict.position
                                      : first_ + static_cast<double>(bracket_.size()) * step_;
  if (!approached_) return Request{std::max(aim - settings_.backlash, limits_.minimum), false};
  return Request{aim, true};
}

void Autofocus::arrived() {
  approached_ = true;
}

void Autofocus::measured(std::shared_ptr<const FrameMeasures> frame) {
  if (confirming_) {
    end_confirmation(std::move(frame));
    return;
  }
  bracket_.push_back({next()->position, std::move(frame)});
  if (bracket_.size() == static_cast<std::size_t>(settings_.points)) end_bracket();
}

void Autofocus::end_bracket() {
  const BracketVerdict verdict = judge_bracket(bracket_);
  switch (verdict.kind) {
    case Kind::peak:
      took_a_peak(verdict);
      break;
    case Kind::flat:
      widen(verdict);
      break;
    case Kind::lower:
    case Kind::higher:
      move_on(verdict);
      break;
    case Kind::rough:
      if (brackets_left_-- > 0) {
        // A shallow curve is disturbed the more; a deep one is no parabola any more.
        const double change = verdict.drop < kSuitableDrop ? kWider : 1.0 / kWider;
        begin_bracket(verdict.position, std::max(change * step_, settings_.step));
      } else {
        out_of_brackets("the detail along the bracket has no single peak");
      }
      break;
  }
  last_kind_ = verdict.kind;
}

void Autofocus::took_a_peak(const BracketVerdict& verdict) {
  const double change = std::abs((verdict.position - plan_.predicted).value);
  if (plan_.largest_change && change > plan_.largest_change->value) {
    give_up(
        text("the peak lies %.1f µm from where it was expected, more than %.1f µm: it is not "
             "believed",
             change, plan_.largest_change->value));
    return;
  }
  const bool is_fine = step_ <= kFineEnough * settings_.step || step_ <= plan_.step;
  candidate_ = Candidate{verdict, step_};
  if (is_fine || brackets_left_ <= 0) {
    confirm();
    return;
  }
  --brackets_left_;
  begin_bracket(verdict.position, std::max(kFiner * step_, settings_.step));
}

void Autofocus::widen(const BracketVerdict& verdict) {
  if (candidate_) {  // a wider bracket has found it, and finer ones tell no more
    confirm();
    return;
  }
  const bool is_widest =
      bracket_.front().position <= window_.minimum && bracket_.back().position >= window_.maximum;
  if (brackets_left_-- > 0 && !is_widest) {
    begin_bracket(verdict.position, kWider * step_);
  } else {
    give_up("the face shows too little detail to focus by");
  }
}

void Autofocus::move_on(const BracketVerdict& verdict) {
  const bool at_rim = verdict.kind == Kind::lower ? bracket_.front().position <= window_.minimum
                                                  : bracket_.back().position >= window_.maximum;
  const double away = std::abs((verdict.position - plan_.predicted).value);
  const bool too_far = plan_.largest_change && away > plan_.largest_change->value;
  if (at_rim || too_far || brackets_left_-- <= 0) {
    out_of_brackets(text("the focus lies beyond %.1f µm, %.1f µm from where it was expected",
                         verdict.position.value, away));
    return;
  }
  begin_bracket(verdict.position, last_kind_ == verdict.kind ? kWider * step_ : step_);
}

void Autofocus::confirm() {
  confirming_ = true;
  approached_ = settings_.backlash.value <= 0.0;
}

void Autofocus::end_confirmation(std::shared_ptr<const FrameMeasures> frame) {
  const BracketVerdict& verdict = candidate_->verdict;
  const std::optional<DetailLevel> level = detail_level(*frame, verdict.tiles);
  const double least = verdict.most - kConfirmedShare -
                       kConfirmed * std::hypot(verdict.uncertainty, level ? level->error : 0.0);
  if (level && level->logarithm >= least) {
    const double half = 0.5 * (settings_.points - 1);
    const double suitable = std::sqrt(2.0 * kSuitableDrop / verdict.curvature) / half;
    found_ = Found{verdict.position, suitable * candidate_->step, std::move(frame), verdict.map};
    ended_ = true;
    return;
  }
  if (brackets_left_-- > 0) {
    begin_bracket(std::exchange(candidate_, std::nullopt)->verdict.position, step_);
  } else {
    give_up("a frame at the peak showed less detail than the bracket around it");
  }
}

void Autofocus::out_of_brackets(const std::string& why) {
  if (candidate_) {
    confirm();
  } else {
    give_up(why);
  }
}

void Autofocus::give_up(const std::string& why) {
  why_not_ = why;
  ended_ = true;
}

}  // namespace biotomy::acquisition
