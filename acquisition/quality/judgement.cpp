#include "acquisition/quality/judgement.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace biotomy::acquisition {
namespace {

std::string sentence(const char* format, double value, double limit) {
  std::array<char, 300> text{};
  // NOLINTNEXTLINE(clang-diagnostic-format-nonliteral): made by callers in one line, from literals
  std::snprintf(text.data(), text.size(), format, value, limit);
  return text.data();
}

}  // namespace

void Judgement::reject(const char* slug, const std::string& reason) {
  if (!result_.slug.empty()) return;
  result_.slug = slug;
  result_.reason = reason;
}

bool Judgement::at_least(const char* name, double value, double limit, const char* slug,
                         const char* format) {
  return add(name, value, limit, value >= limit, slug, format);
}

bool Judgement::at_most(const char* name, double value, double limit, const char* slug,
                        const char* format) {
  return add(name, value, limit, value <= limit, slug, format);
}

bool Judgement::within(const char* name, double value, double limit, const char* slug,
                       const char* format) {
  return add(name, value, limit, std::abs(value) <= limit, slug, format);
}

void Judgement::leave_open(const std::string& what) {
  left_open_ += "; " + what;
}

Assessment Judgement::finish() {
  if (result_.slug.empty()) {
    result_.verdict = Verdict::accepted;
    result_.slug = "good";
    result_.reason = "every metric is within its limit" + left_open_;
  } else {
    result_.verdict = Verdict::rejected;
  }
  return result_;
}

bool Judgement::add(const char* name, double value, double limit, bool passed, const char* slug,
                    const char* format) {
  if (!std::isfinite(value)) {
    reject(slug, std::string(name) + " has no value that could be judged");
    return false;
  }
  result_.metrics.push_back({name, value, limit, passed});
  if (!passed) reject(slug, sentence(format, value, limit));
  return passed;
}

}  // namespace biotomy::acquisition
