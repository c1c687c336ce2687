#pragma once

#include <stdexcept>
#include <string>

namespace biotomy::acquisition {

/// A request that gets no other answer than a status of HTTP and a sentence.
class Refusal : public std::runtime_error {
 public:
  Refusal(int status, const std::string& sentence)
      : std::runtime_error(sentence), status_(status) {}

  int status() const { return status_; }

 private:
  int status_;
};

}  // namespace biotomy::acquisition
