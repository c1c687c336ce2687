#include "tests/quality/set_results.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::tests {
namespace {

bool names(const DefectKind& kind, const std::string& slug) {
  return !slug.empty() && std::ranges::find(kind.slugs, slug) != kind.slugs.end();
}

double value_of(const acquisition::Metric& metric, const DefectKind& kind) {
  return kind.is_change ? std::fabs(metric.value) : metric.value;
}

void add_defective(const JudgedFrame& frame, DefectResult& result) {
  const DefectKind& kind = *result.kind;
  (frame.demand == Demand::reject   ? result.harmful
   : frame.demand == Demand::accept ? result.harmless
                                    : result.between)
      .add(frame);
  if (frame.demand != Demand::reject) return;
  result.named += static_cast<int>(frame.rejected && names(kind, frame.slug));
  if (const auto* metric = frame.metric(kind.metric)) {
    result.values.bad.push_back(value_of(*metric, kind));
  }
  if (kind.most <= kind.harmful) return;
  const double place = std::log(frame.strength / kind.harmful) / std::log(kind.most / kind.harmful);
  result.by_strength.at(static_cast<std::size_t>(std::clamp(3.0 * place, 0.0, 2.0))).add(frame);
}

void add_good(const JudgedFrame& frame, DefectResult& result) {
  ++result.alarms.frames;
  result.alarms.rejected += static_cast<int>(frame.rejected && names(*result.kind, frame.slug));
  if (const auto* metric = frame.metric(result.kind->metric)) {
    const double value = value_of(*metric, *result.kind);
    result.values.good.push_back(value);
    // What passes above its limit must not be low.
    result.values.low_is_bad = metric->passed == (value > metric->limit);
  }
}

}  // namespace

void Rejections::add(const JudgedFrame& frame) {
  ++frames;
  rejected += static_cast<int>(frame.rejected);
}

double DefectResult::goal() const {
  return kind->goal;
}

bool SetResults::reached() const {
  return good.share() <= kMostFalseAlarms && std::ranges::all_of(defects, &DefectResult::reached);
}

SetResults results_of(const std::vector<JudgedFrame>& frames) {
  SetResults results;
  for (const DefectKind& kind : defect_kinds()) results.defects.emplace_back().kind = &kind;
  for (const JudgedFrame& frame : frames) {
    results.all.add(frame);
    results.mean_seconds += frame.seconds / static_cast<double>(frames.size());
    if (frame.defect == Defect::none) {
      results.good.add(frame);
      if (frame.rejected) ++results.alarms[frame.slug];
      for (DefectResult& result : results.defects) add_good(frame, result);
    } else {
      add_defective(frame, *std::ranges::find_if(results.defects, [&](const DefectResult& result) {
                      return result.kind->defect == frame.defect;
                    }));
    }
  }
  return results;
}

}  // namespace biotomy::tests
