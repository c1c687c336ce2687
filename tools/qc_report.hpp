#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "acquisition/quality/assessment.hpp"
#include "acquisition/records/journal_rows.hpp"

namespace biotomy::tools {

/// What is told of one image.
struct JudgedImage {
  std::string name;
  acquisition::Assessment assessment;
  std::optional<std::int64_t> layer;               ///< of a sample
  std::vector<acquisition::AttemptNote> attempts;  ///< what its journal says
};

/// Writes image by image what was found out, as blocks of text or as one JSON document, and keeps
/// nothing but the counts.
class QcReport {
 public:
  QcReport(std::ostream& out, bool json);

  void add(const JudgedImage& image);

  /// An image that cannot be read has a place in the report, too.
  void add_unreadable(const std::string& name, std::optional<std::int64_t> layer,
                      const std::string& why);

  /// Ends the document.
  void finish();

  int rejected() const { return rejected_; }
  int unreadable() const { return unreadable_; }

 private:
  void print(const JudgedImage& image);
  void print_json(const JudgedImage& image);
  void begin_json_entry();

  std::ostream& out_;
  bool json_;
  int images_ = 0;
  int rejected_ = 0;
  int unreadable_ = 0;
};

}  // namespace biotomy::tools
