#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "acquisition/records/sample_records.hpp"
#include "acquisition/worker.hpp"

namespace biotomy::acquisition {

/// The control thread's way to the records: everything is written by the worker, in order.
class RecordKeeper {
 public:
  RecordKeeper(Worker& worker, std::shared_ptr<SampleRecords> records);

  /// Writes without anybody waiting. If it fails, `failure` tells so for ever.
  void post(std::function<void(SampleRecords&)> write);

  /// Writes, and the caller waits for the future before going on.
  template <typename Write>
  auto ask(Write write) {
    return run_on(worker_,
                  [records = records_, write = std::move(write)] { return write(*records); });
  }

  /// Why a posted record could not be written; nothing when all were.
  std::optional<std::string> failure() const;

 private:
  struct Failure;
  Worker& worker_;
  std::shared_ptr<SampleRecords> records_;
  std::shared_ptr<Failure> failure_;
};

}  // namespace biotomy::acquisition
