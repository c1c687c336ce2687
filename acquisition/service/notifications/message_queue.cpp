#include "acquisition/service/notifications/message_queue.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

#include "acquisition/log.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {
namespace {

constexpr const char* kComponent = "notify";
constexpr const char* kExtension = ".json";

/// The number in a message's file name; nothing for any other file.
std::optional<std::uint64_t> number_of(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool whole = error == std::errc() && end == stem.data() + stem.size();
  return whole && file.extension() == kExtension ? std::optional(number) : std::nullopt;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

MessageQueue::MessageQueue(std::filesystem::path folder, std::size_t keep)
    : folder_(std::move(folder)), keep_(keep) {
  reconstruct::create_folders_durably(folder_);
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    const auto number = number_of(entry.path());
    if (!number) continue;
    std::string text = content_of(entry.path());
    if (nlohmann::json::accept(text)) {
      messages_.push_back({*number, std::move(text)});
    } else {
      log_error(kComponent, entry.path().string() + " is no message, and is left where it is");
    }
    next_number_ = std::max(next_number_, *number + 1);
  }
  if (error) {
    throw reconstruct::SampleError("the folder " + folder_.string() +
                                   " of waiting notifications cannot be read: " + error.message() +
                                   "; see notify.queue");
  }
  std::sort(messages_.begin(), messages_.end(),
            [](const Message& a, const Message& b) { return a.number < b.number; });
}

void MessageQueue::push(const std::string& text) {
  while (messages_.size() >= keep_) {
    const auto oldest =
        std::min_element(messages_.begin(), messages_.end(),
                         [](const Message& a, const Message& b) { return a.number < b.number; });
    log_error(kComponent, "too many messages wait in " + folder_.string() +
                              "; the oldest is given up: " + oldest->text);
    pop(oldest->number);
    ++dropped_;
  }
  const std::uint64_t number = next_number_++;
  try {
    reconstruct::write_durably(file_of(number), text);
  } catch (const std::exception& failure) {
    log_error(kComponent, std::string("a message waits in memory alone: ") + failure.what());
  }
  messages_.push_back({number, text});
}

std::optional<MessageQueue::Message> MessageQueue::front() const {
  return messages_.empty() ? std::nullopt : std::optional(messages_.front());
}

std::deque<MessageQueue::Message>::iterator MessageQueue::find(std::uint64_t number) {
  return std::find_if(messages_.begin(), messages_.end(),
                      [number](const Message& message) { return message.number == number; });
}

void MessageQueue::postpone(std::uint64_t number) {
  const auto found = find(number);
  if (found != messages_.end()) std::rotate(found, found + 1, messages_.end());
}

void MessageQueue::pop(std::uint64_t number) {
  const auto found = find(number);
  if (found == messages_.end()) return;
  messages_.erase(found);
  remove(number);
}

std::filesystem::path MessageQueue::file_of(std::uint64_t number) const {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%012llu", static_cast<unsigned long long>(number));
  return folder_ / (name.data() + std::string(kExtension));
}

void MessageQueue::remove(std::uint64_t number) const {
  std::error_code error;
  std::filesystem::remove(file_of(number), error);
  if (error) {
    log_error(kComponent, file_of(number).string() + " cannot be removed, and its message will " +
                              "be sent again: " + error.message());
    return;
  }
  try {
    reconstruct::sync_folder(folder_);
  } catch (const std::exception& failure) {
    log_error(kComponent, failure.what());
  }
}

}  // namespace biotomy::acquisition
