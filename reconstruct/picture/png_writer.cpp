#include "reconstruct/picture/png_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <oneapi/tbb/parallel_for.h>
#include <zlib.h>

#include "reconstruct/picture/png_filter.hpp"
#include "reconstruct/picture/rgb_picture.hpp"
#include "reconstruct/picture/strip_deflate.hpp"

namespace biotomy::reconstruct {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::uint8_t kTruecolour = 2;
constexpr std::uint8_t kMetre = 1;  // of pHYs
constexpr double kMicrometresPerMetre = 1e6;
constexpr std::size_t kStripBytes = std::size_t{1} << 19;  // of rows; a unit of parallel work
constexpr int kRowsOfAFilter = 8;  // choosing costs as much as filtering four times

void append(Bytes& bytes, std::string_view text) {
  for (const char letter : text) {
    bytes.push_back(static_cast<std::byte>(letter));
  }
}

/// The byte of a big-endian number of four at `place`.
std::byte byte_of(std::uint32_t number, std::size_t place) {
  return static_cast<std::byte>(number >> (24U - 8U * static_cast<unsigned>(place)) & 0xFFU);
}

void append_number(Bytes& bytes, std::uint32_t number) {
  for (std::size_t place = 0; place < 4; ++place) {
    bytes.push_back(byte_of(number, place));
  }
}

/// A chunk in which data is yet to be put; end_chunk makes it whole.
Bytes begin_chunk(std::string_view type) {
  Bytes chunk;
  append_number(chunk, 0);
  append(chunk, type);
  return chunk;
}

void end_chunk(Bytes& chunk) {
  const auto length = static_cast<std::uint32_t>(chunk.size() - 8);
  for (std::size_t place = 0; place < 4; ++place) {
    chunk[place] = byte_of(length, place);
  }
  // The checksum covers the type and the data.
  const auto* covered = reinterpret_cast<const Bytef*>(chunk.data() + 4);
  append_number(
      chunk, static_cast<std::uint32_t>(crc32_z(crc32(0, nullptr, 0), covered, chunk.size() - 4)));
}

Bytes header(const cv::Mat& rgb) {
  Bytes chunk = begin_chunk("IHDR");
  append_number(chunk, static_cast<std::uint32_t>(rgb.cols));
  append_number(chunk, static_cast<std::uint32_t>(rgb.rows));
  const auto bits = static_cast<std::uint8_t>(8 * rgb.elemSize1());
  for (const std::uint8_t byte : {bits, kTruecolour, std::uint8_t{0}, std::uint8_t{0},
                                  std::uint8_t{0}}) {  // deflate, the five filters, not interlaced
    chunk.push_back(static_cast<std::byte>(byte));
  }
  end_chunk(chunk);
  return chunk;
}

Bytes pixel_size(double pixel) {
  const double per_metre = std::round(kMicrometresPerMetre / pixel);
  if (!(pixel > 0.0) || per_metre < 1.0 || per_metre > std::numeric_limits<std::int32_t>::max()) {
    return {};  // what the format can't say is left unsaid
  }
  Bytes chunk = begin_chunk("pHYs");
  append_number(chunk, static_cast<std::uint32_t>(per_metre));
  append_number(chunk, static_cast<std::uint32_t>(per_metre));
  chunk.push_back(std::byte{kMetre});
  end_chunk(chunk);
  return chunk;
}

/// International text, not compressed: UTF-8 of no stated language.
Bytes text(std::string_view keyword, std::string_view words) {
  if (words.empty()) {
    return {};
  }
  Bytes chunk = begin_chunk("iTXt");
  append(chunk, keyword);
  chunk.insert(chunk.end(), 5, std::byte{0});
  append(chunk, words);
  end_chunk(chunk);
  return chunk;
}

/// A row's bytes as PNG has them: 16 bits begin with the high ones.
void load_row(const cv::Mat& rgb, int row, std::span<std::uint8_t> bytes) {
  std::memcpy(bytes.data(), rgb.ptr(row), bytes.size());
  if (rgb.depth() == CV_16U && std::endian::native == std::endian::little) {
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
      std::swap(bytes[i], bytes[i + 1]);
    }
  }
}

struct Strip {
  Bytes chunk;         ///< IDAT
  uLong checksum = 0;  ///< Adler-32 of its filtered rows
  std::size_t plain_bytes = 0;
};

Strip encode_strip(const cv::Mat& rgb, int first, int end) {
  const std::size_t row_bytes = static_cast<std::size_t>(rgb.cols) * rgb.elemSize();
  std::vector<std::uint8_t> above(row_bytes, 0);
  std::vector<std::uint8_t> row(row_bytes);
  std::vector<std::uint8_t> filtered((row_bytes + 1) * static_cast<std::size_t>(end - first));
  if (first > 0) {
    load_row(rgb, first - 1, above);
  }
  std::span<std::uint8_t> room(filtered);
  PngFilter filter = PngFilter::up;
  for (int y = first; y < end; ++y) {
    load_row(rgb, y, row);
    if ((y - first) % kRowsOfAFilter == 0) {
      filter = best_png_filter(row, above, rgb.elemSize());
    }
    filter_png_row(filter, row, above, rgb.elemSize(), room.first(row_bytes + 1));
    room = room.subspan(row_bytes + 1);
    std::swap(row, above);
  }
  Strip strip;
  strip.plain_bytes = filtered.size();
  strip.checksum = adler32_z(adler32(0, nullptr, 0), filtered.data(), filtered.size());
  strip.chunk = begin_chunk("IDAT");
  if (first == 0) {
    for (const std::uint8_t byte : kZlibHeader) {
      strip.chunk.push_back(static_cast<std::byte>(byte));
    }
  }
  deflate_strip(filtered, end == rgb.rows, strip.chunk);
  end_chunk(strip.chunk);
  strip.chunk.shrink_to_fit();  // all strips are in memory together
  return strip;
}

/// The checksum of the whole stream, in a chunk of its own: it is known only when all strips are.
Bytes checksum(const std::vector<Strip>& strips) {
  uLong sum = adler32(0, nullptr, 0);
  for (const Strip& strip : strips) {
    sum = adler32_combine(sum, strip.checksum, static_cast<z_off_t>(strip.plain_bytes));
  }
  Bytes chunk = begin_chunk("IDAT");
  append_number(chunk, static_cast<std::uint32_t>(sum));
  end_chunk(chunk);
  return chunk;
}

}  // namespace

std::vector<std::byte> encode_png(const cv::Mat& rgb, const PictureNotes& notes) {
  require_rgb_picture(rgb);
  const std::size_t row_bytes = static_cast<std::size_t>(rgb.cols) * rgb.elemSize();
  const int rows = static_cast<int>(std::max<std::size_t>(1, kStripBytes / row_bytes));
  std::vector<Strip> strips(static_cast<std::size_t>((rgb.rows + rows - 1) / rows));
  tbb::parallel_for(std::size_t{0}, strips.size(), [&](std::size_t number) {
    const int first = static_cast<int>(number) * rows;
    strips[number] = encode_strip(rgb, first, std::min(first + rows, rgb.rows));
  });

  std::size_t size = 4096 + notes.title.size() + notes.description.size();
  for (const Strip& strip : strips) {
    size += strip.chunk.size();
  }
  Bytes file;
  file.reserve(size);
  append(file, {reinterpret_cast<const char*>(kSignature.data()), kSignature.size()});
  for (const Bytes& chunk :
       {header(rgb), pixel_size(notes.pixel), text("Title", notes.title),
        text("Description", notes.description), text("Software", "Biotomy " BIOTOMY_VERSION)}) {
    file.insert(file.end(), chunk.begin(), chunk.end());
  }
  const Bytes sum = checksum(strips);
  for (Strip& strip : strips) {
    file.insert(file.end(), strip.chunk.begin(), strip.chunk.end());
    strip.chunk = {};  // the file has it now
  }
  file.insert(file.end(), sum.begin(), sum.end());
  Bytes end = begin_chunk("IEND");
  end_chunk(end);
  file.insert(file.end(), end.begin(), end.end());
  return file;
}

}  // namespace biotomy::reconstruct
