#include "tests/faults/rig_bench.hpp"

#include <chrono>

namespace biotomy::tests {

namespace {

constexpr std::chrono::seconds kPatience(20);

}  // namespace

RigBench::RigBench(const std::filesystem::path& socket)
    : client_(socket, bridge::RigService::bench) {}

void RigBench::begin_fault(const std::string& name, const std::string& event) {
  client_.ask(bridge::BeginFaultMessage{name, event}, kPatience);
}

void RigBench::end_fault(const std::string& name) {
  client_.ask(bridge::EndFaultMessage{name}, kPatience);
}

void RigBench::set_input(bridge::RigInput input, bool on) {
  client_.ask(bridge::SetInputMessage{input, on}, kPatience);
}

}  // namespace biotomy::tests
