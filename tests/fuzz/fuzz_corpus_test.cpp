#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_targets.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// What the fuzzers start from, and what they once found, without a fuzzer.
class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {
 protected:
  static fs::path folder(const std::string& kind) {
    return fs::path(BIOTOMY_FUZZ_FOLDER) / kind / GetParam().name;
  }

  static std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> files;
    if (!fs::is_directory(folder)) {
      return files;
    }
    for (const auto& entry : fs::directory_iterator(folder)) {
      std::ifstream in(entry.path(), std::ios::binary);
      files[entry.path().filename()] = {std::istreambuf_iterator<char>(in), {}};
    }
    return files;
  }

  static bool run(const std::string& text) {
    return GetParam().run(std::as_bytes(std::span(text)));
  }
};

TEST_P(FuzzCorpus, SeedsAreTaken) {
  const auto seeds = files_in(folder("corpus"));
  EXPECT_FALSE(seeds.empty());
  for (const auto& [name, text] : seeds) {
    EXPECT_TRUE(run(text)) << name;
  }
}

/// Seeds cut short, and what a fuzzer found in an earlier version: there need not be any of it.
TEST_P(FuzzCorpus, DamageIsTakenOrRefusedClearly) {
  constexpr std::size_t kCuts = 50;
  for (const auto& [name, text] : files_in(folder("corpus"))) {
    for (std::size_t length = 0; length < text.size(); length += 1 + text.size() / kCuts) {
      EXPECT_NO_THROW(run(text.substr(0, length))) << name << " cut to " << length;
    }
  }
  for (const auto& [name, text] : files_in(folder("regression"))) {
    EXPECT_NO_THROW(run(text)) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(, FuzzCorpus, testing::ValuesIn(kFuzzTargets),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace biotomy::tests
