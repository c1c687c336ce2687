#include "acquisition/service/rig_findings.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

namespace biotomy::acquisition {

using Kind = RigFinding::Kind;

void RigFindings::good(const std::string& part, const std::string& text) {
  findings_.push_back({part, Kind::good, text});
}

void RigFindings::note(const std::string& part, const std::string& text) {
  findings_.push_back({part, Kind::note, text});
}

void RigFindings::wrong(const std::string& part, const std::string& text) {
  findings_.push_back({part, Kind::wrong, text});
}

void RigFindings::wrong(const std::string& part, const Complaints& complaints) {
  for (const std::string& complaint : complaints) wrong(part, complaint);
}

bool RigFindings::can_start() const {
  return std::none_of(findings_.begin(), findings_.end(),
                      [](const RigFinding& finding) { return finding.kind == Kind::wrong; });
}

const char* to_string(Kind kind) {
  switch (kind) {
    case Kind::good:
      return "good";
    case Kind::note:
      return "note";
    case Kind::wrong:
      return "wrong";
  }
  return "unknown";
}

std::string findings_text(const RigFindings& findings) {
  std::ostringstream text;
  int wrong = 0;
  for (const RigFinding& finding : findings.all()) {
    const bool is_wrong = finding.kind == Kind::wrong;
    if (is_wrong) ++wrong;
    text << std::left << std::setw(7) << (is_wrong ? "WRONG" : to_string(finding.kind))
         << std::setw(15) << finding.part << finding.text << '\n';
  }
  if (wrong == 0) {
    text << "a job could start\n";
  } else {
    text << "a job would not start: " << wrong << (wrong == 1 ? " thing is" : " things are")
         << " wrong\n";
  }
  return text.str();
}

std::string findings_json(const RigFindings& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const RigFinding& finding : findings.all()) {
    list.push_back(
        {{"part", finding.part}, {"kind", to_string(finding.kind)}, {"text", finding.text}});
  }
  const nlohmann::ordered_json document{{"can_start", findings.can_start()}, {"findings", list}};
  // A message may hold a name of a file in any encoding.
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace biotomy::acquisition
