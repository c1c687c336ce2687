#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>

namespace biotomy::acquisition {

/// The messages that wait to be delivered on one way, oldest first, a file each, so that they are
/// still there after a crash. There are so many at most; the oldest go. When a file cannot be
/// written the message waits in memory: a full disk is a reason to tell, not to be silent.
/// One thread at a time uses it.
class MessageQueue {
 public:
  /// Takes up what waits in the folder, which is made when missing. Throws SampleError when the
  /// folder cannot be made or read.
  MessageQueue(std::filesystem::path folder, std::size_t keep);

  struct Message {
    std::uint64_t number = 0;  ///< grows with each message
    std::string text;
  };

  void push(const std::string& text);

  std::optional<Message> front() const;

  /// Puts the message with this number behind the others, until the queue is opened anew.
  void postpone(std::uint64_t number);

  /// Lets go of the message with this number, if it is still there.
  void pop(std::uint64_t number);

  std::size_t size() const { return messages_.size(); }

  /// How many were pushed out by newer ones since the queue was opened.
  std::uint64_t dropped() const { return dropped_; }

 private:
  std::filesystem::path file_of(std::uint64_t number) const;
  std::deque<Message>::iterator find(std::uint64_t number);
  void remove(std::uint64_t number) const;

  std::filesystem::path folder_;
  std::size_t keep_;
  std::deque<Message> messages_;
  std::uint64_t next_number_ = 1;
  std::uint64_t dropped_ = 0;
};

}  // namespace biotomy::acquisition
