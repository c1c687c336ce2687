#pragma once

#include <string>
#include <vector>

#include "acquisition/job/preflight_complaints.hpp"

namespace biotomy::acquisition {

/// What was found of one part of a rig.
struct RigFinding {
  enum class Kind {
    good,
    note,   ///< worth knowing; no reason not to start
    wrong,  ///< a job would not start
  };
  std::string part;  ///< "controller", "lines", "camera" …
  Kind kind = Kind::good;
  std::string text;
};

/// All that a check of a rig found, in the order of looking.
class RigFindings {
 public:
  void good(const std::string& part, const std::string& text);
  void note(const std::string& part, const std::string& text);
  void wrong(const std::string& part, const std::string& text);
  void wrong(const std::string& part, const Complaints& complaints);

  const std::vector<RigFinding>& all() const { return findings_; }
  bool can_start() const;

 private:
  std::vector<RigFinding> findings_;
};

/// For people: a line each, and a last one that says whether a job could start.
std::string findings_text(const RigFindings& findings);

/// For programs: {"can_start": …, "findings": [{"part", "kind", "text"}]}.
std::string findings_json(const RigFindings& findings);

const char* to_string(RigFinding::Kind kind);

}  // namespace biotomy::acquisition
