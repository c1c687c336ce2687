#include "tests/faults/run_witness.hpp"

#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "tests/integration/witness_lines.hpp"

namespace biotomy::tests {

namespace {

using nlohmann::json;

class Reader {
 public:
  void take(const json& line) {
    const std::string event = line.at("event");
    if (event == "command_started") {
      command_started(line);
    } else if (event == "command_finished") {
      command_finished(line);
    } else if (event == "capture") {
      capture(line);
    } else if (event == "faulted") {
      witness_.stops.push_back(line.at("time"));
    } else if (event == "twin_started") {
      twin_started(line);
    }
  }

  Witness finish() && { return std::move(witness_); }

 private:
  bool pass_is_open() const {
    return !witness_.passes.empty() && witness_.passes.back().result.empty();
  }

  void command_started(const json& line) {
    const std::string action = line.at("action");
    if (frame_waits_ && action == "move_column") witness_.frames.back().column_moved_next = true;
    frame_waits_ = false;
    if (action != "grind_pass") return;
    witness_.passes.push_back({.sequence = line.at("sequence"),
                               .target_um = line.at("position_um"),
                               .began_at = line.at("time"),
                               .result = {}});
  }

  void command_finished(const json& line) {
    if (pass_is_open() && witness_.passes.back().sequence == line.at("sequence")) {
      witness_.passes.back().result = line.at("result");
    }
  }

  void capture(const json& line) {
    witness_.frames.push_back({.number = line.at("number"),
                               .at = line.at("time"),
                               .face_um = line.at("face_um"),
                               .column_um = line.at("column_um"),
                               .face_in_view = line.at("face_in_view"),
                               .lamp_on = line.at("lamp_on"),
                               .spoilt = line.value("spoilt", false)});
    frame_waits_ = true;
  }

  void twin_started(const json& line) {
    frame_waits_ = false;
    if (std::exchange(started_, true)) witness_.stops.push_back(line.at("time"));
    if (!pass_is_open()) return;
    WitnessedPass& pass = witness_.passes.back();
    if (pass.sequence != line.at("sequence")) {
      witness_.contradictions.push_back("the twin was killed during command " +
                                        std::to_string(pass.sequence) + " and remembers " +
                                        line.at("sequence").dump());
    }
    pass.result = line.at("result");
  }

  Witness witness_;
  bool started_ = false;
  bool frame_waits_ = false;  ///< for the command that follows the last frame
};

}  // namespace

Witness read_witness(const std::filesystem::path& log) {
  if (!std::filesystem::exists(log))
    throw std::runtime_error("there is no witness log " + log.string());
  Reader reader;
  for (const std::string& line : witness_lines(log)) {
    try {
      reader.take(json::parse(line));
    } catch (const json::exception& error) {
      throw std::runtime_error(log.string() + ": " + error.what() + ": " + line);
    }
  }
  return std::move(reader).finish();
}

}  // namespace biotomy::tests
