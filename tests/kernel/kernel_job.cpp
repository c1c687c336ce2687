// kernel_job: on the kernel, does a job on its devices to the end, whatever was done of it before,
// and says what the journal held before and what the daemon says is committed.
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include "tests/faults/run_journal.hpp"
#include "tests/faults/status_watch.hpp"
#include "tests/kernel/kernel_plan.hpp"
#include "tests/kernel/kernel_rig.hpp"

namespace biotomy::tests {
namespace {

void work(const std::filesystem::path& folder, int layers) {
  std::filesystem::create_directories(folder);
  std::cout << "found " << read_run_journal(folder / "sample/journal.sqlite").layers.size()
            << " layers in the journal" << std::endl;
  KernelRig rig(folder, kernel_plan(layers));
  rig.start_daemon();
  StatusWatch watch(rig.url());
  std::int64_t committed = -1;
  std::string state;
  while (state != "done") {
    const nlohmann::json status = watch.look();
    if (status.at("committed") != committed) {
      committed = status.at("committed");
      std::cout << "committed " << committed << std::endl;
    }
    if (status.at("state") != state) {
      state = status.at("state");
      std::cout << "is " << state << ' ' << told(status) << std::endl;
    }
    if (state == "idle" || state == "faulted" || state == "paused") rig.person().go_on();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const Outcome end = rig.end_daemon();
  if (end.exit_code != 0) throw std::runtime_error(end.output + end.errors);
}

}  // namespace
}  // namespace biotomy::tests

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: kernel_job FOLDER LAYERS\n";
    return 2;
  }
  try {
    biotomy::tests::work(argv[1], std::stoi(argv[2]));
  } catch (const std::exception& error) {
    std::cerr << "kernel_job: " << error.what() << '\n';
    return 1;
  }
}
