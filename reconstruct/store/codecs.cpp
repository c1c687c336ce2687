#include "reconstruct/store/codecs.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

#include <blosc.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <zstd.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/crc32c.hpp"

namespace biotomy::reconstruct {

/// What squeezes the bytes of a chunk, as a name stands for it.
struct Compressor {
  enum class Kind { none, blosc, zstd };

  const char* name = nullptr;
  Kind kind = Kind::none;
  int level = 0;
  const char* blosc_compressor = nullptr;
  int blosc_shuffle = BLOSC_NOSHUFFLE;
};

namespace {

using Bytes = std::vector<std::byte>;

constexpr int kColours = 3;
constexpr std::size_t kChecksumBytes = 4;
constexpr int kLz4Level = 5;
constexpr int kZstdLevel = 1;
constexpr const char* kUndecodable = "Blosc cannot decompress it";

// What Blosc is told where it does not shuffle, for which the size of a value means nothing else:
// LZ4's blocks are as small as they are asked for only when values are too large to be split into
// streams of bytes (above 16). A divisor of a row of voxels' bytes wherever its length is a
// multiple of 8.
constexpr std::size_t kUnsplitValueBytes = 24;

constexpr std::array kCompressors{
    Compressor{.name = "raw"},
    Compressor{"blosc-lz4-noshuffle", Compressor::Kind::blosc, kLz4Level, "lz4", BLOSC_NOSHUFFLE},
    Compressor{"blosc-lz4-shuffle", Compressor::Kind::blosc, kLz4Level, "lz4", BLOSC_SHUFFLE},
    Compressor{"blosc-lz4-bitshuffle", Compressor::Kind::blosc, kLz4Level, "lz4", BLOSC_BITSHUFFLE},
    Compressor{"blosc-zstd1-noshuffle", Compressor::Kind::blosc, kZstdLevel, "zstd",
               BLOSC_NOSHUFFLE},
    Compressor{"blosc-zstd1-shuffle", Compressor::Kind::blosc, kZstdLevel, "zstd", BLOSC_SHUFFLE},
    Compressor{"blosc-zstd1-bitshuffle", Compressor::Kind::blosc, kZstdLevel, "zstd",
               BLOSC_BITSHUFFLE},
    Compressor{"zstd1", Compressor::Kind::zstd, kZstdLevel},
};

const Compressor& compressor_named(const std::string& name) {
  const auto* found = std::find_if(kCompressors.begin(), kCompressors.end(),
                                   [&](const Compressor& each) { return name == each.name; });
  if (found == kCompressors.end()) {
    std::string known;
    for (const std::string& each : codec_names()) {
      known += (known.empty() ? "" : ", ") + each;
    }
    throw InvalidRequest("codec " + name + " is not known; there are " + known);
  }
  return *found;
}

const char* shuffle_name(int shuffle) {
  return shuffle == BLOSC_NOSHUFFLE ? "noshuffle"
         : shuffle == BLOSC_SHUFFLE ? "shuffle"
                                    : "bitshuffle";
}

/// A row of voxels over memory that stays another's.
cv::Mat row_over(std::byte* data, std::size_t voxels, int type) {
  return {1, static_cast<int>(voxels), type, data};
}
cv::Mat row_over(const std::byte* data, std::size_t voxels, int type) {
  return row_over(const_cast<std::byte*>(data), voxels, type);  // cv::Mat knows no const
}

/// Between a voxel's colours side by side and the three colour planes one after the other.
void interleaved_to_planar(std::span<const std::byte> voxels, std::span<std::byte> planes,
                           std::size_t count, int depth) {
  const std::size_t plane_bytes = planes.size() / kColours;
  std::array<cv::Mat, kColours> out;
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = row_over(planes.data() + c * plane_bytes, count, CV_MAKETYPE(depth, 1));
  }
  cv::split(row_over(voxels.data(), count, CV_MAKETYPE(depth, kColours)), out.data());
}
void planar_to_interleaved(std::span<const std::byte> planes, std::span<std::byte> voxels,
                           std::size_t count, int depth) {
  const std::size_t plane_bytes = planes.size() / kColours;
  std::array<cv::Mat, kColours> in;
  for (std::size_t c = 0; c < in.size(); ++c) {
    in[c] = row_over(planes.data() + c * plane_bytes, count, CV_MAKETYPE(depth, 1));
  }
  cv::Mat out = row_over(voxels.data(), count, CV_MAKETYPE(depth, kColours));
  cv::merge(in.data(), in.size(), out);
}

/// What a Blosc buffer says of itself.
struct BloscHeader {
  std::size_t value_bytes = 0;  ///< above 0
  bool is_plain = false;        ///< holds what it was made of as it was, as its last bytes
};

/// Whether the header of a valid Blosc buffer names this compressor. Blosc would meet another one
/// that it lacks with a line on stderr, and one that it has with a chunk that no writer of ours
/// made.
bool is_made_by(std::string_view compressor, std::span<const std::byte> encoded) {
  const char* library = blosc_cbuffer_complib(encoded.data());
  return library != nullptr &&
         library == std::string_view(compressor == BLOSC_LZ4_COMPNAME ? BLOSC_LZ4_LIBNAME
                                                                      : BLOSC_ZSTD_LIBNAME);
}

/// Throws SampleError unless `encoded` is a buffer of this compressor that says that it is made of
/// `plain_bytes`.
BloscHeader blosc_header(std::span<const std::byte> encoded, const Compressor& compressor,
                         std::size_t plain_bytes) {
  std::size_t size = 0;
  BloscHeader header;
  int flags = 0;
  const bool is_valid = blosc_cbuffer_validate(encoded.data(), encoded.size(), &size) == 0 &&
                        size == plain_bytes && is_made_by(compressor.blosc_compressor, encoded);
  if (is_valid) {
    blosc_cbuffer_metainfo(encoded.data(), &header.value_bytes, &flags);
    header.is_plain = (flags & BLOSC_MEMCPYED) != 0;
  }
  if (!is_valid || header.value_bytes == 0 ||
      (header.is_plain && encoded.size() != plain_bytes + BLOSC_MIN_HEADER_LENGTH)) {
    throw SampleError(kUndecodable);
  }
  return header;
}

/// Bytes of a block of a chunk that Blosc compresses; 0 lets it choose.
std::size_t block_bytes(const VolumeLayout& layout, int value_bytes) {
  return layout.interleaved ? static_cast<std::size_t>(layers_of_a_block(layout.chunk[0])) *
                                  static_cast<std::size_t>(layout.chunk[1]) *
                                  static_cast<std::size_t>(layout.chunk[2]) * kColours *
                                  static_cast<std::size_t>(value_bytes)
                            : 0;
}

void append_checksum(Bytes& encoded) {
  const std::uint32_t crc = crc32c(encoded);
  for (std::size_t i = 0; i < kChecksumBytes; ++i) {
    encoded.push_back(static_cast<std::byte>(crc >> (8 * i)));
  }
}

std::span<const std::byte> without_checksum(std::span<const std::byte> encoded) {
  if (encoded.size() < kChecksumBytes) {
    throw SampleError("it is too short");
  }
  const auto body = encoded.first(encoded.size() - kChecksumBytes);
  std::uint32_t stored = 0;
  for (std::size_t i = 0; i < kChecksumBytes; ++i) {
    stored |= std::to_integer<std::uint32_t>(encoded[body.size() + i]) << (8 * i);
  }
  if (stored != crc32c(body)) {
    throw SampleError("its checksum is wrong");
  }
  return body;
}

}  // namespace

std::vector<std::string> codec_names() {
  std::vector<std::string> names;
  names.reserve(kCompressors.size());
  for (const Compressor& each : kCompressors) {
    names.emplace_back(each.name);
  }
  return names;
}

void check_codec_name(const std::string& name) {
  compressor_named(name);
}

nlohmann::json codec_chain(const VolumeLayout& layout, int bits) {
  const Compressor& compressor = compressor_named(layout.codec);
  nlohmann::json chain = nlohmann::json::array();
  if (layout.interleaved) {
    chain.push_back({{"name", "transpose"}, {"configuration", {{"order", {1, 2, 3, 0}}}}});
  }
  chain.push_back({{"name", "bytes"}, {"configuration", {{"endian", "little"}}}});
  switch (compressor.kind) {
    case Compressor::Kind::none:
      break;
    case Compressor::Kind::blosc:
      chain.push_back({{"name", "blosc"},
                       {"configuration",
                        {{"cname", compressor.blosc_compressor},
                         {"clevel", compressor.level},
                         {"shuffle", shuffle_name(compressor.blosc_shuffle)},
                         {"typesize", bits / 8},
                         {"blocksize", block_bytes(layout, bits / 8)}}}});
      break;
    case Compressor::Kind::zstd:
      chain.push_back({{"name", "zstd"},
                       {"configuration", {{"level", compressor.level}, {"checksum", false}}}});
      break;
  }
  chain.push_back({{"name", "crc32c"}});
  return chain;
}

ChunkCodec::ChunkCodec(const VolumeLayout& layout, int bits)
    : compressor_(compressor_named(layout.codec)),
      interleaved_(layout.interleaved),
      layers_(static_cast<std::size_t>(layout.chunk[0])),
      voxels_(static_cast<std::size_t>(layout.chunk[0]) *
              static_cast<std::size_t>(layout.chunk[1]) *
              static_cast<std::size_t>(layout.chunk[2])),
      value_bytes_(static_cast<std::size_t>(bits) / 8),
      block_bytes_(block_bytes(layout, bits / 8)) {}

Bytes ChunkCodec::encode(std::span<const std::byte> voxels) const {
  Bytes encoded;
  if (interleaved_) {
    encoded = compress(voxels);
  } else {
    Bytes planes(voxels.size());
    interleaved_to_planar(voxels, planes, voxels_, value_bytes_ == 1 ? CV_8U : CV_16U);
    encoded = compress(planes);
  }
  append_checksum(encoded);
  return encoded;
}

void ChunkCodec::decode(std::span<const std::byte> encoded, std::span<std::byte> voxels) const {
  decode_body(without_checksum(encoded), voxels);
}

void ChunkCodec::decode_body(std::span<const std::byte> body, std::span<std::byte> voxels) const {
  if (interleaved_) {
    decompress(body, voxels);
  } else {
    Bytes planes(voxels.size());
    decompress(body, planes);
    planar_to_interleaved(planes, voxels, voxels_, value_bytes_ == 1 ? CV_8U : CV_16U);
  }
}

bool ChunkCodec::decodes_by_layers() const {
  return interleaved_ && compressor_.kind != Compressor::Kind::zstd;
}

std::span<const std::byte> ChunkCodec::decode_layers(std::span<const std::byte> encoded,
                                                     ChunkLayers layers,
                                                     std::span<std::byte> room) const {
  const std::span<const std::byte> body = without_checksum(encoded);
  if (interleaved_ && compressor_.kind == Compressor::Kind::none && body.size() == room.size()) {
    return body;
  }
  if (interleaved_ && compressor_.kind == Compressor::Kind::blosc) {
    const BloscHeader header = blosc_header(body, compressor_, room.size());
    if (header.is_plain) {
      return body.last(room.size());
    }
    if (decompress_layers(body, header.value_bytes, layers, room)) {
      return room;
    }
  }
  decode_body(body, room);
  return room;
}

/// Blosc counts in values of the size that its buffer names. False where the layers do not begin
/// and end with one, or are all of the chunk.
bool ChunkCodec::decompress_layers(std::span<const std::byte> body, std::size_t value_bytes,
                                   ChunkLayers layers, std::span<std::byte> room) const {
  const std::size_t layer_bytes = room.size() / layers_;
  const std::size_t first = static_cast<std::size_t>(layers.first) * layer_bytes;
  const std::size_t bytes = static_cast<std::size_t>(layers.end - layers.first) * layer_bytes;
  if (bytes == room.size() || first % value_bytes != 0 || bytes % value_bytes != 0) {
    return false;
  }
  return blosc_getitem(body.data(), static_cast<int>(first / value_bytes),
                       static_cast<int>(bytes / value_bytes),
                       room.data() + first) == static_cast<int>(bytes);
}

Bytes ChunkCodec::compress(std::span<const std::byte> plain) const {
  switch (compressor_.kind) {
    case Compressor::Kind::none:
      break;
    case Compressor::Kind::blosc: {
      Bytes encoded(plain.size() + BLOSC_MAX_OVERHEAD);
      const int size = blosc_compress_ctx(
          compressor_.level, compressor_.blosc_shuffle,
          compressor_.blosc_shuffle == BLOSC_NOSHUFFLE ? kUnsplitValueBytes : value_bytes_,
          plain.size(), plain.data(), encoded.data(), encoded.size(), compressor_.blosc_compressor,
          block_bytes_, 1);
      if (size <= 0) {
        throw SampleError(std::string("Blosc cannot compress a chunk with ") + compressor_.name);
      }
      encoded.resize(static_cast<std::size_t>(size));
      return encoded;
    }
    case Compressor::Kind::zstd: {
      Bytes encoded(ZSTD_compressBound(plain.size()));
      const std::size_t size = ZSTD_compress(encoded.data(), encoded.size(), plain.data(),
                                             plain.size(), compressor_.level);
      if (ZSTD_isError(size) != 0) {
        throw SampleError(std::string("zstd cannot compress a chunk: ") + ZSTD_getErrorName(size));
      }
      encoded.resize(size);
      return encoded;
    }
  }
  return {plain.begin(), plain.end()};
}

void ChunkCodec::decompress(std::span<const std::byte> encoded, std::span<std::byte> plain) const {
  switch (compressor_.kind) {
    case Compressor::Kind::none:
      if (encoded.size() != plain.size()) {
        throw SampleError("it has not the size of a chunk");
      }
      std::memcpy(plain.data(), encoded.data(), plain.size());
      return;
    case Compressor::Kind::blosc:
      blosc_header(encoded, compressor_, plain.size());
      if (blosc_decompress_ctx(encoded.data(), plain.data(), plain.size(), 1) !=
          static_cast<int>(plain.size())) {
        throw SampleError(kUndecodable);
      }
      return;
    case Compressor::Kind::zstd:
      if (ZSTD_decompress(plain.data(), plain.size(), encoded.data(), encoded.size()) !=
          plain.size()) {
        throw SampleError("zstd cannot decompress it");
      }
      return;
  }
}

}  // namespace biotomy::reconstruct
