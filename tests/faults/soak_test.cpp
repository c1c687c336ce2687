// A long run: what the daemon holds of the machine must not grow with the layers.
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/process_resources.hpp"
#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr int kDefaultLayers = 200;
constexpr seconds kWithoutALayer{60};
/// What the allocator's arenas and SQLite's cache may still grow by after the first third.
constexpr std::int64_t kSlackKib = 12 * 1024;

int layers_asked_for() {
  const char* text = std::getenv("BIOTOMY_SOAK_LAYERS");
  return text != nullptr ? std::max(30, std::atoi(text)) : kDefaultLayers;
}

/// The most of each that was held in a part of the run.
struct Peak {
  ProcessResources most;
  void add(const ProcessResources& held) {
    most.resident_kib = std::max(most.resident_kib, held.resident_kib);
    most.open_files = std::max(most.open_files, held.open_files);
    most.threads = std::max(most.threads, held.threads);
  }
};

TEST(Soak, MemoryFilesAndThreadsStayFlat) {
  const int layers = layers_asked_for();
  std::cout << "BIOTOMY_SOAK_LAYERS=" << layers << (layers < 5000 ? " (whole: 5000)" : "")
            << std::endl;
  SimulatedRig rig(RigPlan{.width = 96,
                           .height = 80,
                           .layers = layers,
                           .layer_thickness_um = 10,  // 5000 of them are within the twin's axes
                           .time_scale = 1000});
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);

  std::vector<Peak> thirds(3);
  std::int64_t committed = 0;
  auto last_layer = steady_clock::now();
  while (true) {
    const nlohmann::json status = rig.status();
    if (status.at("state") == "done") break;
    ASSERT_NE(status.at("state"), "faulted") << status.dump(1);
    const std::int64_t now = status.at("committed");
    if (now > committed) last_layer = steady_clock::now();
    ASSERT_LT(steady_clock::now() - last_layer, kWithoutALayer) << status.dump(1);
    committed = now;
    const auto third = std::min<std::size_t>(2, static_cast<std::size_t>(3 * committed / layers));
    thirds[third].add(resources_of(rig.daemon_pid()));
    std::this_thread::sleep_for(milliseconds(100));
  }
  EXPECT_EQ(rig.status().at("committed"), layers);

  for (const Peak& peak : thirds) {
    std::cout << peak.most.resident_kib << " KiB, " << peak.most.open_files << " files, "
              << peak.most.threads << " threads at most in a third of the run\n";
  }
  EXPECT_LE(thirds[2].most.resident_kib, thirds[1].most.resident_kib + kSlackKib);
  // A status that is asked for, a band that is written: a file more or less.
  EXPECT_LE(thirds[2].most.open_files, thirds[1].most.open_files + 3);
  EXPECT_LE(thirds[2].most.threads, thirds[1].most.threads);
}

}  // namespace
}  // namespace biotomy::tests
