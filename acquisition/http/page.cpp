#include "acquisition/http/page.hpp"

#include <array>
#include <memory>
#include <stdexcept>
#include <string_view>

#include <openssl/sha.h>
#include <zlib.h>

namespace biotomy::acquisition {
namespace {

constexpr std::string_view kAssets = "/assets/";
constexpr const char* kIndex = "/index.html";
constexpr std::size_t kTagDigits = 16;
constexpr int kGzipWindow = 15 + 16;  // as inflateInit2 wants it for a gzip header

std::string tag_of(std::string_view content) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(content.data()), content.size(), digest.data());
  std::string tag = "\"";
  for (std::size_t i = 0; i < kTagDigits / 2; ++i) {
    tag += kDigits[digest[i] >> 4U];
    tag += kDigits[digest[i] & 15U];
  }
  return tag + "\"";
}

/// For the rare client that takes no gzip; all browsers do.
std::string unpacked(std::string_view gzip) {
  z_stream stream{};
  if (inflateInit2(&stream, kGzipWindow) != Z_OK) throw std::runtime_error("no room to unpack");
  const std::unique_ptr<z_stream, decltype(&::inflateEnd)> end(&stream, ::inflateEnd);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
  stream.avail_in = static_cast<uInt>(gzip.size());
  std::string text;
  std::array<char, 16384> piece{};
  int result = Z_OK;
  while (result == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = piece.size();
    result = inflate(&stream, Z_NO_FLUSH);
    text.append(piece.data(), piece.size() - stream.avail_out);
  }
  if (result != Z_STREAM_END) throw std::runtime_error("a file of the page is damaged");
  return text;
}

}  // namespace

Page::Page(std::span<const PageAsset> assets) {
  for (const PageAsset& asset : assets) {
    files_[std::string(asset.path)] = {.asset = asset, .tag = tag_of(asset.gzip)};
  }
}

bool Page::answers(const ApiRequest& request) const {
  return request.path == "/" || request.path.starts_with(kAssets) || files_.contains(request.path);
}

ApiResponse Page::answer(const ApiRequest& request) const {
  if (request.method != "GET") return wrong_method(request, "GET");
  const bool is_asset = request.path.starts_with(kAssets);
  const auto found = files_.find(request.path == "/" ? kIndex : request.path);
  if (found == files_.end()) {
    if (is_asset) return error_response(404, "there is no " + request.path);
    return {.content_type = "text/html; charset=utf-8", .body = no_page_html()};
  }
  const File& file = found->second;
  ApiResponse response{.content_type = std::string(file.asset.content_type)};
  response.headers["ETag"] = file.tag;
  response.headers["Vary"] = "Accept-Encoding";
  response.headers["Cache-Control"] = is_asset ? "public, max-age=31536000, immutable" : "no-cache";
  if (has_already(request, file.tag)) {
    response.status = 304;
  } else if (request.accept_encoding.find("gzip") != std::string::npos) {
    response.headers["Content-Encoding"] = "gzip";
    response.body = file.asset.gzip;
  } else {
    response.body = unpacked(file.asset.gzip);
  }
  return response;
}

std::string no_page_html() {
  return R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Biotomy</title>
</head>
<body>
<main>
<h1>Biotomy</h1>
<p>This program was built without its page. What the page would show is here:</p>
<ul>
<li><a href="/api/v1/status">the status of the rig</a></li>
<li><a href="/api/v1/layers">the layers that are stored</a></li>
<li><a href="/metrics">metrics for Prometheus</a></li>
</ul>
<p>On a command line, <code>biotomy rig status</code> and <code>biotomy rig watch</code> tell the same.</p>
</main>
</body>
</html>
)html";
}

}  // namespace biotomy::acquisition
