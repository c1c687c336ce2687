#include "acquisition/viewer/volume_files.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "acquisition/viewer/file_version.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "acquisition/viewer/request_text.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMetadata = "zarr.json";
constexpr std::size_t kMostDigits = 9;

bool is_number(std::string_view word) {
  return !word.empty() && word.size() <= kMostDigits &&
         word.find_first_not_of("0123456789") == std::string_view::npos;
}

std::vector<std::string_view> words_of(std::string_view name) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t slash = std::min(name.find('/', begin), name.size());
    words.push_back(name.substr(begin, slash - begin));
    begin = slash + 1;
  }
  return words;
}

/// Where no link on the way leads out of the volume.
bool lies_in(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error) return false;
  const fs::path real_folder = fs::canonical(folder, error);
  if (error) return false;
  return std::mismatch(real_folder.begin(), real_folder.end(), real.begin(), real.end()).first ==
         real_folder.end();
}

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

bool is_volume_name(const std::string& name) {
  const std::vector<std::string_view> words = words_of(name);
  if (words.back() == kMetadata) {
    return words.size() == 1 || (words.size() == 2 && is_number(words[0]));
  }
  return words.size() == 6 && is_number(words[0]) && words[1] == "c" &&
         std::all_of(words.begin() + 2, words.end(), is_number);
}

/// Lets the one other page look at the response.
void VolumeFiles::allow(const ApiRequest& request, ApiResponse& response) const {
  response.headers["Vary"] = "Origin";
  if (origin_.empty() || request.origin != origin_) return;
  response.headers["Access-Control-Allow-Origin"] = origin_;
  response.headers["Access-Control-Expose-Headers"] =
      "Accept-Ranges, Content-Length, Content-Range, ETag";
}

ApiResponse VolumeFiles::answer(const std::string& name, const ApiRequest& request) const {
  if (request.method == "OPTIONS") {
    ApiResponse response{.status = 204, .body = {}};
    allow(request, response);
    if (response.headers.contains("Access-Control-Allow-Origin")) {
      response.headers["Access-Control-Allow-Methods"] = "GET, HEAD";
      response.headers["Access-Control-Allow-Headers"] = "Range, If-None-Match";
      response.headers["Access-Control-Allow-Private-Network"] = "true";
      response.headers["Access-Control-Max-Age"] = "600";
    }
    response.headers["Allow"] = "GET, HEAD, OPTIONS";
    return response;
  }
  const fs::path file = volume_ / name;
  std::error_code error;
  if (!is_volume_name(name) || !fs::is_regular_file(file, error) || !lies_in(volume_, file)) {
    // A chunk that is not there is an answer to programs that read volumes: all of it is 0.
    ApiResponse response = error_response(404, "the volume has no file of that name");
    allow(request, response);
    return response;
  }
  const std::uint64_t size = fs::file_size(file, error);
  const std::string etag = '"' + file_version(file) + '"';
  ApiResponse response{
      .status = 200,
      .content_type = name.ends_with(kMetadata) ? "application/json" : "application/octet-stream",
      .body = {},
      .headers = {{"ETag", etag}, {"Accept-Ranges", "bytes"}, {"Cache-Control", "no-cache"}}};
  allow(request, response);
  if (has_already(request, etag)) {
    response.status = 304;
    return response;
  }
  const std::optional<ByteRange> range = byte_range(request.range, size);
  if (!range) {
    ApiResponse refusal = error_response(416, "the file has " + std::to_string(size) + " bytes");
    allow(request, refusal);
    refusal.headers["Content-Range"] = "bytes */" + std::to_string(size);
    return refusal;
  }
  if (*range != ByteRange{0, size}) {
    response.status = 206;
    response.headers["Content-Range"] = "bytes " + std::to_string(range->begin) + '-' +
                                        std::to_string(range->begin + range->bytes - 1) + '/' +
                                        std::to_string(size);
  }
  response.file = FilePart{file, range->begin, range->bytes};
  return response;
}

}  // namespace biotomy::acquisition
