// The hands of a person at the twin, for tests that are not written in C++.
// usage: rig_hand SOCKET press|release estop|door
//        rig_hand SOCKET break NAME EVENT     EVENT: TOML, as a table of a scenario (sim/README.md)
//        rig_hand SOCKET mend NAME
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "tests/faults/rig_bench.hpp"

namespace {

using biotomy::bridge::RigInput;

constexpr int kWrongUsage = 2;

int wrong_usage() {
  std::fprintf(stderr,
               "rig_hand: usage: rig_hand SOCKET press|release estop|door, "
               "rig_hand SOCKET break NAME EVENT, or rig_hand SOCKET mend NAME\n");
  return kWrongUsage;
}

int act(const std::vector<std::string>& words) {
  if (words.size() < 3) return wrong_usage();
  const std::string& verb = words[1];
  const std::string& object = words[2];
  biotomy::tests::RigBench bench(words[0]);
  if ((verb == "press" || verb == "release") && (object == "estop" || object == "door")) {
    bench.set_input(object == "estop" ? RigInput::estop : RigInput::door, verb == "press");
  } else if (verb == "break" && words.size() == 4) {
    bench.begin_fault(object, words[3]);
  } else if (verb == "mend") {
    bench.end_fault(object);
  } else {
    return wrong_usage();
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    return act({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rig_hand: %s\n", error.what());
    return 1;
  }
}
