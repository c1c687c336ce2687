#pragma once

#include <string>
#include <vector>

#include "reconstruct/sample/finding.hpp"

namespace biotomy::reconstruct {

/// Listens to a verification. A finding is `NAME: what`, its file's path below `root`.
struct HeardFindings {
  explicit HeardFindings(std::filesystem::path folder) : root(std::move(folder)) {}

  VerificationListener listener() {
    return {
        [this](const Finding& finding) {
          findings.push_back(finding.file.lexically_relative(root).string() + ": " + finding.what);
        },
        [this](std::int64_t done_now, std::int64_t all) {
          done = done_now;
          total = all;
        }};
  }

  std::filesystem::path root;
  std::vector<std::string> findings;
  std::int64_t done = 0;
  std::int64_t total = 0;
};

}  // namespace biotomy::reconstruct
