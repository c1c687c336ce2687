#include "acquisition/viewer/file_response.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>

#include "acquisition/viewer/file_version.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/request_text.hpp"

namespace biotomy::acquisition {
namespace {

std::optional<std::uint64_t> position(std::string_view text) {
  const auto value = whole_number(text, 0, std::numeric_limits<std::int64_t>::max());
  return value ? std::optional(static_cast<std::uint64_t>(*value)) : std::nullopt;
}

}  // namespace

std::optional<ByteRange> byte_range(const std::string& header, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  const ByteRange whole{0, size};
  if (!header.starts_with(kUnit)) return whole;
  const std::string_view asked = std::string_view(header).substr(kUnit.size());
  const std::size_t dash = asked.find('-');
  if (dash == std::string_view::npos) return whole;
  const std::string_view first = asked.substr(0, dash);
  const std::string_view last = asked.substr(dash + 1);
  if (first.empty()) {
    const auto count = position(last);
    if (!count) return whole;
    if (*count == 0 || size == 0) return std::nullopt;
    const std::uint64_t bytes = std::min(*count, size);
    return ByteRange{size - bytes, bytes};
  }
  const auto begin = position(first);
  const auto end =
      last.empty() ? std::optional(std::numeric_limits<std::uint64_t>::max()) : position(last);
  if (!begin || !end || *end < *begin) return whole;
  if (*begin >= size) return std::nullopt;
  return ByteRange{*begin, std::min(*end, size - 1) - *begin + 1};
}

ApiResponse file_response(const ApiRequest& request, const std::filesystem::path& file,
                          const std::string& content_type) {
  // Files are replaced while they are served: length, tag and bytes are those of the one opened
  // here.
  auto opened = std::make_shared<const bridge::UniqueFd>(
      ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat status {};
  if (!opened->valid() || ::fstat(opened->get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw Refusal(404, "the file is gone");
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  const std::string etag = '"' + file_version(status) + '"';
  ApiResponse response{
      .status = 200,
      .content_type = content_type,
      .body = {},
      .headers = {{"ETag", etag}, {"Accept-Ranges", "bytes"}, {"Cache-Control", "no-cache"}}};
  if (has_already(request, etag)) {
    response.status = 304;
    return response;
  }
  const bool of_another = !request.if_range.empty() && request.if_range != etag;
  const std::optional<ByteRange> range = byte_range(of_another ? "" : request.range, size);
  if (!range) {
    ApiResponse refusal = error_response(416, "the file has " + std::to_string(size) + " bytes");
    refusal.headers["Content-Range"] = "bytes */" + std::to_string(size);
    return refusal;
  }
  if (*range != ByteRange{0, size}) {
    response.status = 206;
    response.headers["Content-Range"] = "bytes " + std::to_string(range->begin) + '-' +
                                        std::to_string(range->begin + range->bytes - 1) + '/' +
                                        std::to_string(size);
  }
  response.file = FilePart{std::move(opened), range->begin, range->bytes};
  return response;
}

}  // namespace biotomy::acquisition
