#include "acquisition/records/record_keeper.hpp"

#include <mutex>
#include <utility>

namespace biotomy::acquisition {

struct RecordKeeper::Failure {
  std::mutex mutex;
  std::optional<std::string> what;
};

RecordKeeper::RecordKeeper(Worker& worker, std::shared_ptr<SampleRecords> records)
    : worker_(worker), records_(std::move(records)), failure_(std::make_shared<Failure>()) {}

void RecordKeeper::post(std::function<void(SampleRecords&)> write) {
  worker_.post([records = records_, failure = failure_, write = std::move(write)] {
    try {
      write(*records);
    } catch (const std::exception& error) {
      const std::scoped_lock lock(failure->mutex);
      if (!failure->what) failure->what = error.what();
    }
  });
}

std::optional<std::string> RecordKeeper::failure() const {
  const std::scoped_lock lock(failure_->mutex);
  return failure_->what;
}

}  // namespace biotomy::acquisition
