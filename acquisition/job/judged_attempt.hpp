#pragma once

#include <cstdint>
#include <string>

#include "acquisition/quality/assessment.hpp"

namespace biotomy::acquisition {

/// What was thought of the last frame that was judged.
struct JudgedAttempt {
  std::int64_t layer = 0;
  int attempt = 0;
  Verdict verdict = Verdict::rejected;
  std::string slug;    ///< the reason in a word, as in Assessment
  std::string reason;  ///< the same in words

  bool operator==(const JudgedAttempt&) const = default;
};

}  // namespace biotomy::acquisition
