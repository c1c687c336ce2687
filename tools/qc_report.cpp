#include "tools/qc_report.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iomanip>

#include <nlohmann/json.hpp>

#include "acquisition/quality/metrics_json.hpp"

namespace biotomy::tools {
namespace {

using acquisition::Assessment;
using acquisition::AttemptNote;
using acquisition::Metric;
using acquisition::metrics_json;
using acquisition::Verdict;
using nlohmann::ordered_json;

constexpr const char* kUnreadable = "unreadable";

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

/// The value that an attempt had of a metric; empty without one.
std::string recorded(const AttemptNote* attempt, const std::string& name) {
  if (attempt == nullptr) return "";
  for (const Metric& metric : attempt->metrics) {
    if (metric.name == name) return number(metric.value);
  }
  return "";
}

ordered_json attempts_json(const std::vector<AttemptNote>& attempts) {
  ordered_json list = ordered_json::array();
  for (const AttemptNote& attempt : attempts) {
    list.push_back({{"attempt", attempt.attempt},
                    {"taken_at", attempt.taken_at},
                    {"verdict", attempt.verdict},
                    {"reason", attempt.reason},
                    {"file", attempt.file},
                    {"metrics", metrics_json(attempt.metrics)}});
  }
  return list;
}

/// A file's name may be in any encoding, and an error names a file.
std::string text_of(const ordered_json& entry) {
  return entry.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

QcReport::QcReport(std::ostream& out, bool json) : out_(out), json_(json) {
  if (json_) out_ << "{\n\"frames\": [";
}

void QcReport::add(const JudgedImage& image) {
  if (image.assessment.verdict == Verdict::rejected) ++rejected_;
  if (json_) {
    print_json(image);
  } else {
    print(image);
  }
  ++images_;
}

void QcReport::add_unreadable(const std::string& name, std::optional<std::int64_t> layer,
                              const std::string& why) {
  if (json_) {
    begin_json_entry();
    ordered_json entry = {{"file", name}};
    if (layer) entry["layer"] = *layer;
    entry["verdict"] = kUnreadable;
    entry["reason"] = why;
    out_ << text_of(entry);
  } else {
    out_ << name << "  " << kUnreadable << ": " << why << '\n';
  }
  ++images_;
  ++unreadable_;
}

void QcReport::begin_json_entry() {
  out_ << (images_ == 0 ? "\n" : ",\n");
}

void QcReport::print(const JudgedImage& image) {
  const Assessment& assessment = image.assessment;
  out_ << image.name << "  " << to_string(assessment.verdict) << ": " << assessment.reason << '\n';
  for (const AttemptNote& attempt : image.attempts) {
    out_ << "  journal: attempt " << attempt.attempt << ", " << attempt.taken_at << ", "
         << attempt.verdict << ": " << attempt.reason << '\n';
  }
  const AttemptNote* last = image.attempts.empty() ? nullptr : &image.attempts.back();
  for (const Metric& metric : assessment.metrics) {
    out_ << "  " << std::left << std::setw(24) << metric.name << std::right << std::setw(10)
         << number(metric.value) << (metric.passed ? "  " : " !") << "  limit" << std::setw(10)
         << number(metric.limit);
    const std::string then = recorded(last, metric.name);
    if (!then.empty()) out_ << "  in the journal" << std::setw(10) << then;
    out_ << '\n';
  }
}

void QcReport::print_json(const JudgedImage& image) {
  begin_json_entry();
  const Assessment& assessment = image.assessment;
  ordered_json entry = {{"file", image.name}};
  if (image.layer) entry["layer"] = *image.layer;
  entry["verdict"] = to_string(assessment.verdict);
  entry["slug"] = assessment.slug;
  entry["reason"] = assessment.reason;
  entry["metrics"] = metrics_json(assessment.metrics);
  if (image.layer) entry["journal"] = attempts_json(image.attempts);
  out_ << text_of(entry);
}

void QcReport::finish() {
  const int accepted = images_ - rejected_ - unreadable_;
  if (json_) {
    out_ << "\n],\n\"accepted\": " << accepted << ",\n\"rejected\": " << rejected_
         << ",\n\"unreadable\": " << unreadable_ << "\n}\n";
    return;
  }
  out_ << images_ << (images_ == 1 ? " frame: " : " frames: ") << accepted << " accepted, "
       << rejected_ << " rejected";
  if (unreadable_ > 0) out_ << ", " << unreadable_ << " unreadable";
  out_ << '\n';
}

}  // namespace biotomy::tools
