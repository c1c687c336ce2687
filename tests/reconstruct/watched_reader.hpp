#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "reconstruct/store/local_object_reader.hpp"

namespace biotomy::reconstruct {

/// Counts what is asked of it, and lets a test act before a read.
class WatchedReader final : public LocalObjectReader {
 public:
  struct Record {
    std::atomic<int> reads = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> expected;  ///< offset, length
    std::function<void()> before_read = [] {};
  };

  WatchedReader(std::filesystem::path root, std::shared_ptr<Record> record, std::size_t most_open)
      : LocalObjectReader(std::move(root), most_open), record_(std::move(record)) {}

  void read(const std::string& name, const ObjectVersion& version, std::uint64_t offset,
            std::span<std::byte> out) override {
    record_->before_read();
    ++record_->reads;
    LocalObjectReader::read(name, version, offset, out);
  }
  void expect(const std::string& name, const ObjectVersion& version, std::uint64_t offset,
              std::uint64_t length) override {
    record_->expected.emplace_back(offset, length);
    LocalObjectReader::expect(name, version, offset, length);
  }

 private:
  std::shared_ptr<Record> record_;
};

}  // namespace biotomy::reconstruct
