#pragma once

#include <cstdint>
#include <string>

namespace biotomy::acquisition {

enum class NoticeKind {
  fault,
  pause,        ///< that no operator asked for
  done,         ///< the job is at its end
  low_disk,     ///< the disk will not take the layers that are still to come
  stalled,      ///< no new layer for far longer than a layer takes
  interrupted,  ///< the daemon ended while the rig worked, and was started again
  test,
};

const char* to_string(NoticeKind kind);

/// What a person is told.
struct Notice {
  NoticeKind kind = NoticeKind::test;
  bool over = false;  ///< that trouble of this kind has ended, not that it has begun
  std::string text;   ///< a sentence
  std::string at;     ///< ISO 8601, UTC
  long count = 1;     ///< how often it happened since the last message of it
  std::string job;
  std::string state;  ///< of the job
  std::int64_t layer = 0;
  std::int64_t layers = 0;
  std::int64_t committed = 0;
};

/// The message as it is sent: one JSON object, with the name of this computer and an id by which a
/// receiver knows a message that it got twice.
std::string notice_json(const Notice& notice, const std::string& id);

}  // namespace biotomy::acquisition
