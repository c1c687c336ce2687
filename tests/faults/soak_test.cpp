// A long run: what the daemon holds of the machine must not grow with the layers.
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <limits>
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

/// What was held in a part of the run: of memory the most; of files and threads, which come and go
/// with each band of the volume, the least, below which a leak would not let them fall again.
struct Held {
  std::int64_t resident_kib = 0;
  std::int64_t open_files = std::numeric_limits<std::int64_t>::max();
  std::int64_t threads = std::numeric_limits<std::int64_t>::max();
  void add(const ProcessResources& now) {
    resident_kib = std::max(resident_kib, now.resident_kib);
    open_files = std::min(open_files, now.open_files);
    threads = std::min(threads, now.threads);
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

  std::vector<Held> thirds(3);
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

  for (const Held& held : thirds) {
    std::cout << "in a third of the run: at most " << held.resident_kib << " KiB, at least "
              << held.open_files << " files, " << held.threads << " threads\n";
  }
  EXPECT_LE(thirds[2].resident_kib, thirds[1].resident_kib + kSlackKib);
  // A viewer's connection or two may be open whenever one looks.
  EXPECT_LE(thirds[2].open_files, thirds[1].open_files + 3);
  EXPECT_LE(thirds[2].threads, thirds[1].threads + 1);
}

}  // namespace
}  // namespace biotomy::tests
