#include "acquisition/service/notifications/notice.hpp"

#include <array>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace biotomy::acquisition {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

}  // namespace

const char* to_string(NoticeKind kind) {
  switch (kind) {
    case NoticeKind::fault:
      return "fault";
    case NoticeKind::pause:
      return "pause";
    case NoticeKind::done:
      return "done";
    case NoticeKind::low_disk:
      return "low_disk";
    case NoticeKind::stalled:
      return "stalled";
    case NoticeKind::interrupted:
      return "interrupted";
    case NoticeKind::test:
      return "test";
  }
  return "?";
}

std::string notice_json(const Notice& notice, const std::string& id) {
  using nlohmann::json;
  const json document = {{"id", id},
                         {"kind", to_string(notice.kind)},
                         {"over", notice.over},
                         {"text", notice.text},
                         {"at", notice.at},
                         {"count", notice.count},
                         {"host", host_name()},
                         {"job", notice.job},
                         {"state", notice.state},
                         {"layer", notice.layer},
                         {"layers", notice.layers},
                         {"committed", notice.committed}};
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace biotomy::acquisition
