#include "tests/faults/recovery_table.hpp"

#include <iostream>
#include <utility>

#include <gtest/gtest.h>

namespace biotomy::tests {

namespace {

std::vector<Recovery>& noted() {
  static std::vector<Recovery> recoveries;
  return recoveries;
}

class Table : public testing::Environment {
 public:
  void TearDown() override {
    if (noted().empty()) return;
    std::cout
        << "| fault | what the operator is told | wheel told to stop after, ms | from mending "
           "to the next layer, ms |\n| --- | --- | --- | --- |\n";
    for (const Recovery& recovery : noted()) {
      std::cout << "| " << recovery.fault << " | " << recovery.told << " | "
                << (recovery.to_stop ? std::to_string(recovery.to_stop->count()) : "it stood")
                << " | " << recovery.to_layer.count() << " |\n";
    }
    std::cout << std::flush;
  }
};

const testing::Environment* const kTable = testing::AddGlobalTestEnvironment(new Table);

}  // namespace

void note_recovery(Recovery recovery) {
  noted().push_back(std::move(recovery));
}

}  // namespace biotomy::tests
