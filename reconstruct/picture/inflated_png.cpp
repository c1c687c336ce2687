#include "reconstruct/picture/inflated_png.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <libdeflate.h>

#include "reconstruct/picture/png_chunk.hpp"
#include "reconstruct/picture/strip_deflate.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kHeaderBytes = 13;                         // of IHDR's data
constexpr std::size_t kLargestRatio = 1032;                      // of DEFLATE: 258 bytes by 2 bits
constexpr std::size_t kMostOfABlock = 0xFFFF;                    // bytes that are stored together
constexpr std::uint64_t kMostOfAChunk = std::uint64_t{1} << 30;  // PNG has less than 2³¹

/// Bytes of the filtered rows; none for what is not to be inflated here.
std::optional<std::uint64_t> filtered_bytes(const PngChunk& header) {
  if (!header.is("IHDR") || header.data().size() != kHeaderBytes) {
    return std::nullopt;
  }
  const auto width = std::uint64_t{png_number(header.data())};
  const auto height = std::uint64_t{png_number(header.data().subspan(4))};
  const auto depth = std::to_integer<unsigned>(header.data()[8]);
  const auto colour_type = std::to_integer<unsigned>(header.data()[9]);
  const bool interlaced = header.data()[12] != std::byte{0};
  constexpr std::array<unsigned, 7> kSamples{1, 0, 3, 1, 2, 0, 4};  // by the colour's type
  if (interlaced || colour_type >= kSamples.size() || kSamples[colour_type] == 0 || depth > 16) {
    return std::nullopt;
  }
  return height * (1 + (width * kSamples[colour_type] * depth + 7) / 8);
}

/// The data of the chunks one after the other, and where in the file they begin and end.
struct CompressedPixels {
  std::vector<std::byte> stream;
  std::size_t first = 0;
  std::size_t end = 0;
};

std::optional<CompressedPixels> compressed_pixels(std::span<const std::byte> file,
                                                  std::size_t position) {
  CompressedPixels pixels;
  pixels.stream.reserve(file.size());
  for (auto chunk = png_chunk_at(file, position); chunk;
       position += chunk->whole.size(), chunk = png_chunk_at(file, position)) {
    if (chunk->is("IDAT")) {
      pixels.first = pixels.stream.empty() ? position : pixels.first;
      pixels.stream.insert(pixels.stream.end(), chunk->data().begin(), chunk->data().end());
    } else if (!pixels.stream.empty()) {
      pixels.end = position;
      return pixels;
    }
  }
  return std::nullopt;
}

bool inflate(std::span<const std::byte> stream, std::span<std::byte> plain) {
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  return decompressor != nullptr &&
         libdeflate_zlib_decompress(decompressor.get(), stream.data(), stream.size(), plain.data(),
                                    plain.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

std::array<std::byte, 4> png_bytes(std::uint64_t number) {
  return {std::byte(number >> 24 & 0xFF), std::byte(number >> 16 & 0xFF),
          std::byte(number >> 8 & 0xFF), std::byte(number & 0xFF)};
}

}  // namespace

std::optional<InflatedPng> InflatedPng::of(std::span<const std::byte> file) {
  const auto header = is_png(file) ? png_chunk_at(file, kPngSignature.size()) : std::nullopt;
  const auto bytes = header ? filtered_bytes(*header) : std::nullopt;
  if (!bytes || *bytes == 0 || *bytes > kMostOfAChunk) {
    return std::nullopt;
  }
  const auto compressed = compressed_pixels(file, kPngSignature.size() + header->whole.size());
  if (!compressed || *bytes > compressed->stream.size() * kLargestRatio) {
    return std::nullopt;  // before memory is asked for that no stream of this length can fill
  }
  auto pixels = std::make_unique_for_overwrite<std::byte[]>(*bytes);
  if (!inflate(compressed->stream, {pixels.get(), *bytes})) {
    return std::nullopt;
  }
  InflatedPng png(std::move(pixels));
  png.parts_.push_back(file.first(compressed->first));
  png.add_stream(*bytes);
  png.parts_.push_back(file.subspan(compressed->end));
  return png;
}

void InflatedPng::add_stream(std::size_t bytes) {
  const std::size_t blocks = (bytes + kMostOfABlock - 1) / kMostOfABlock;
  const auto length = png_bytes(kZlibHeader.size() + blocks * sizeof(BlockStart) + bytes + 4);
  start_ = std::make_unique<StreamStart>(StreamStart{
      length[0], length[1], length[2], length[3], std::byte{'I'}, std::byte{'D'}, std::byte{'A'},
      std::byte{'T'}, std::byte{kZlibHeader[0]}, std::byte{kZlibHeader[1]}});
  parts_.push_back(*start_);
  block_starts_.reserve(blocks);
  for (std::size_t first = 0; first < bytes; first += kMostOfABlock) {
    const std::size_t size = std::min(bytes - first, kMostOfABlock);
    const bool last = first + size == bytes;
    block_starts_.push_back({std::byte{last}, std::byte(size & 0xFF), std::byte(size >> 8),
                             std::byte(~size & 0xFF), std::byte(~size >> 8 & 0xFF)});
    parts_.push_back(block_starts_.back());
    parts_.push_back({pixels_.get() + first, size});
  }
  const auto adler = png_bytes(libdeflate_adler32(1, pixels_.get(), bytes));
  end_ = std::make_unique<StreamEnd>();  // whoever reads this does not look at the chunk's CRC
  std::copy(adler.begin(), adler.end(), end_->begin());
  parts_.push_back(*end_);
}

}  // namespace biotomy::reconstruct
