#include "acquisition/job/job_status.hpp"

#include <utility>

namespace biotomy::acquisition {

void StatusBoard::publish(JobStatus status) {
  std::shared_ptr<const JobStatus> next = std::make_shared<const JobStatus>(std::move(status));
  const std::scoped_lock lock(mutex_);
  status_.swap(next);
}

std::shared_ptr<const JobStatus> StatusBoard::look() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

}  // namespace biotomy::acquisition
