#pragma once

#include <string>

#include "acquisition/quality/assessment.hpp"

namespace biotomy::acquisition {

/// Collects the metrics of one frame; the first that fails gives the reason.
class Judgement {
 public:
  /// `slug` names the reason in a file's name, `reason` is a sentence.
  void reject(const char* slug, const std::string& reason);

  /// A metric with its limit. `format` makes the reason of value and limit, both %f, should it
  /// fail. Whether it passed. A value that is no number fails, and is no metric of the frame.
  bool at_least(const char* name, double value, double limit, const char* slug, const char* format);
  bool at_most(const char* name, double value, double limit, const char* slug, const char* format);
  /// The value may be above or below zero by the limit.
  bool within(const char* name, double value, double limit, const char* slug, const char* format);

  /// Something that could not be judged, in words: it becomes part of the reason for accepting.
  void leave_open(const std::string& what);

  Assessment& result() { return result_; }

  /// The verdict.
  Assessment finish();

 private:
  bool add(const char* name, double value, double limit, bool passed, const char* slug,
           const char* format);

  Assessment result_;
  std::string left_open_;
};

}  // namespace biotomy::acquisition
