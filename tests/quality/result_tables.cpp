#include "tests/quality/result_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace biotomy::tests {
namespace {

std::string number(const char* format, double value) {
  std::array<char, 64> text{};
  // NOLINTNEXTLINE(clang-diagnostic-format-nonliteral): literals of this file
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string percent(double share) {
  return std::isnan(share) ? "–" : number("%.1f", 100.0 * share);
}

std::string count_and_share(const Rejections& found) {
  if (found.frames == 0) return "–";
  return percent(found.share()) + " of " + std::to_string(found.frames);
}

std::string strength(const DefectKind& kind) {
  if (kind.harmful >= kind.most) return "always";
  return "≥ " + number("%g", kind.harmful) + " " + kind.unit;
}

std::string detection_row(const DefectResult& result) {
  const std::string named =
      result.harmful.rejected == 0
          ? "–"
          : percent(static_cast<double>(result.named) / result.harmful.rejected);
  const bool has_metric = result.has_metric();
  return std::string("| ") + result.kind->name + " | " + strength(*result.kind) + " | " +
         std::to_string(result.harmful.frames) + " | " + percent(result.harmful.share()) + " | " +
         number("%g", 100.0 * result.goal()) + " | " + named + " | " +
         number("%.2f", 100.0 * result.alarms.share()) + " | " +
         (has_metric ? "`" + std::string(result.kind->metric) + "`" : "none") + " | " +
         (has_metric ? number("%.4f", area_under_roc(result.values)) : "–") + " | " +
         (has_metric ? percent(detection_at(result.values, SetResults::kMostFalseAlarms)) : "–") +
         " |\n";
}

std::string strength_row(const DefectResult& result) {
  const DefectKind& kind = *result.kind;
  const double step = std::cbrt(kind.most / kind.harmful);
  const auto until = [&](double factor) { return number("%.3g", kind.harmful * factor); };
  return std::string("| ") + kind.name + ", " + kind.unit + " | " +
         count_and_share(result.harmless) + " | " + count_and_share(result.between) + " | " +
         until(1.0) + " | " + count_and_share(result.by_strength[0]) + " | " + until(step) + " | " +
         count_and_share(result.by_strength[1]) + " | " + until(step * step) + " | " +
         count_and_share(result.by_strength[2]) + " | " + until(step * step * step) + " |\n";
}

std::string good_frames(const SetResults& results) {
  std::string text = std::to_string(results.good.rejected) + " of " +
                     std::to_string(results.good.frames) + " good frames " +
                     (results.good.rejected == 1 ? "was" : "were") + " rejected, " +
                     number("%.2f", 100.0 * results.good.share()) + " % (goal: at most " +
                     number("%g", 100.0 * SetResults::kMostFalseAlarms) + ")";
  const char* separator = ": ";
  for (const auto& [slug, count] : results.alarms) {
    text += separator + std::to_string(count) + " as `" + slug + "`";
    separator = ", ";
  }
  return text + ". An assessment took " + number("%.1f", 1e3 * results.mean_seconds) +
         " ms on one core, mean of " + std::to_string(results.all.frames) + " frames.\n";
}

}  // namespace

std::string markdown(const SetResults& results) {
  std::string text =
      "| defect | must be rejected from | frames | rejected, % | goal, % | rightly named, % | good "
      "frames rejected for it, % | metric | area under its ROC | detected by it alone at 0.5 % "
      "false alarms, % |\n"
      "| --- | --- | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: |\n";
  for (const DefectResult& result : results.defects) text += detection_row(result);
  text +=
      "\n" + good_frames(results) +
      "\nRejected, % of so many frames, by the strength of the defect:\n\n"
      "| defect, strength | harmless | grey zone | from | weak | to | middle | to | strong | to "
      "|\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const DefectResult& result : results.defects) {
    if (result.kind->harmful < result.kind->most) text += strength_row(result);
  }
  return text;
}

std::string json(const SetResults& results) {
  const auto rejections = [](const Rejections& found) {
    return nlohmann::json{{"frames", found.frames}, {"rejected", found.rejected}};
  };
  nlohmann::json defects = nlohmann::json::array();
  for (const DefectResult& result : results.defects) {
    nlohmann::json entry{{"defect", result.kind->name},
                         {"unit", result.kind->unit},
                         {"harmless_up_to", result.kind->harmless},
                         {"harmful_from", result.kind->harmful},
                         {"harmless", rejections(result.harmless)},
                         {"between", rejections(result.between)},
                         {"harmful", rejections(result.harmful)},
                         {"rightly_named", result.named},
                         {"good", rejections(result.alarms)},
                         {"goal", result.goal()},
                         {"reached", result.reached()}};
    if (result.has_metric()) {
      nlohmann::json points = nlohmann::json::array();
      for (const double alarms : {0.0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5}) {
        points.push_back(
            {{"false_alarms", alarms}, {"detected", detection_at(result.values, alarms)}});
      }
      entry["metric"] = result.kind->metric;
      entry["roc_area"] = area_under_roc(result.values);
      entry["roc"] = std::move(points);
    }
    defects.push_back(std::move(entry));
  }
  return nlohmann::json{
      {"frames", results.all.frames},       {"good", rejections(results.good)},
      {"good_rejected_as", results.alarms}, {"mean_seconds", results.mean_seconds},
      {"reached", results.reached()},       {"defects", std::move(defects)}}
      .dump(2);
}

std::string wrong_answers(const std::vector<JudgedFrame>& frames) {
  std::string text;
  for (const JudgedFrame& frame : frames) {
    const Demand answer = frame.rejected ? Demand::reject : Demand::accept;
    if (frame.demand == Demand::either || frame.demand == answer) continue;
    const bool good = frame.defect == Defect::none;
    text += "sequence " + std::to_string(frame.sequence) + ", layer " +
            std::to_string(frame.layer) + ", " +
            (good ? "good" : kind_of(frame.defect).name + number(" %.3g", frame.strength)) +
            number(", contrast %.3f: ", frame.contrast) + (frame.rejected ? "" : "not ") +
            "rejected: " + frame.reason + "\n";
  }
  return text;
}

}  // namespace biotomy::tests
