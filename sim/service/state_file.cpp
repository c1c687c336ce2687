#include "sim/service/state_file.hpp"

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::sim {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 2;

Json to_json(const RigState& state) {
  return {{"version", kVersion},
          {"sequence_started", state.memory.sequence_started},
          {"sequence_finished", state.memory.sequence_finished},
          {"result", static_cast<int>(state.memory.result)},
          {"grind_count", state.memory.grind_count},
          {"ground_position_um", state.memory.ground_position_um},
          {"strip_depth_um", state.machine.block.strip_depth_um},
          {"passes", state.machine.block.passes},
          {"blown_ms", state.machine.block.blown_ms},
          {"feed_um", state.machine.feed_um},
          {"traverse_um", state.machine.traverse_um},
          {"column_um", state.machine.column_um},
          {"wheel_worn_um", state.machine.wheel_worn_um}};
}

RigState from_json(const Json& json) {
  if (json.at("version") != kVersion) {
    throw std::runtime_error("made by another version of the twin");
  }
  RigState state;
  json.at("sequence_started").get_to(state.memory.sequence_started);
  json.at("sequence_finished").get_to(state.memory.sequence_finished);
  const int result = json.at("result").get<int>();
  if (result < static_cast<int>(CommandResult::none) ||
      result > static_cast<int>(CommandResult::aborted)) {
    throw std::runtime_error("no such result: " + std::to_string(result));
  }
  state.memory.result = static_cast<CommandResult>(result);
  json.at("grind_count").get_to(state.memory.grind_count);
  json.at("ground_position_um").get_to(state.memory.ground_position_um);
  if (json.at("strip_depth_um").size() != Block::kStrips) {
    throw std::runtime_error("strip_depth_um must hold " + std::to_string(Block::kStrips) +
                             " depths");
  }
  json.at("strip_depth_um").get_to(state.machine.block.strip_depth_um);
  json.at("passes").get_to(state.machine.block.passes);
  json.at("blown_ms").get_to(state.machine.block.blown_ms);
  json.at("feed_um").get_to(state.machine.feed_um);
  json.at("traverse_um").get_to(state.machine.traverse_um);
  json.at("column_um").get_to(state.machine.column_um);
  json.at("wheel_worn_um").get_to(state.machine.wheel_worn_um);
  return state;
}

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw std::system_error(errno, std::generic_category(), "state_file " + file.string());
}

void write_whole(const std::filesystem::path& file, std::string_view text) {
  const bridge::UniqueFd out(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!out.valid()) {
    fail(file);
  }
  while (!text.empty()) {
    const ssize_t count = ::write(out.get(), text.data(), text.size());
    if (count < 0 && errno != EINTR) {
      fail(file);
    }
    text.remove_prefix(count < 0 ? 0 : static_cast<std::size_t>(count));
  }
  if (fsync(out.get()) != 0) {
    fail(file);
  }
}

void synchronise_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const bridge::UniqueFd handle(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!handle.valid() || fsync(handle.get()) != 0) {
    fail(folder);
  }
}

}  // namespace

std::optional<RigState> StateFile::read() const {
  if (file_.empty() || !std::filesystem::exists(file_)) {
    return std::nullopt;
  }
  std::ifstream in(file_);
  try {
    return from_json(Json::parse(in));
  } catch (const std::exception& error) {
    throw std::runtime_error("state_file " + file_.string() + " is damaged (" + error.what() +
                             "); remove it to start with a fresh block");
  }
}

void StateFile::write(const RigState& state) const {
  if (file_.empty()) {
    return;
  }
  std::filesystem::path beside = file_;
  beside += ".new";
  write_whole(beside, to_json(state).dump(2) + '\n');
  if (std::rename(beside.c_str(), file_.c_str()) != 0) {
    fail(file_);
  }
  synchronise_folder(file_);
}

}  // namespace biotomy::sim
