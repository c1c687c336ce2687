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

/// Whether the header of a valid Blosc buffer names this compressor. Blosc would meet another one
/// that it lacks with a line on stderr, and one that it has with a chunk that no writer of ours
/// made.
bool is_made_by(std::string_view compressor, std::span<const std::byte> encoded) {
  const char* library = blosc_cbuffer_complib(encoded.data());
  return library != nullptr &&
         library == std::string_view(compressor == BLOSC_LZ4_COMPNAME ? BLOSC_LZ4_LIBNAME
                                                                      : BLOSC_ZSTD_LIBNAME);
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
                         {"blocksize", 0}}}});
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
      voxels_(static_cast<std::size_t>(layout.chunk[0]) *
              static_cast<std::size_t>(layout.chunk[1]) *
              static_cast<std::size_t>(layout.chunk[2])),
      value_bytes_(static_cast<std::size_t>(bits) / 8) {}

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
  const std::span<const std::byte> body = without_checksum(encoded);
  if (interleaved_) {
    decompress(body, voxels);
  } else {
    Bytes planes(voxels.size());
    decompress(body, planes);
    planar_to_interleaved(planes, voxels, voxels_, value_bytes_ == 1 ? CV_8U : CV_16U);
  }
}

Bytes ChunkCodec::compress(std::span<const std::byte> plain) const {
  switch (compressor_.kind) {
    case Compressor::Kind::none:
      break;
    case Compressor::Kind::blosc: {
      Bytes encoded(plain.size() + BLOSC_MAX_OVERHEAD);
      const int size = blosc_compress_ctx(compressor_.level, compressor_.blosc_shuffle,
                                          value_bytes_, plain.size(), plain.data(), encoded.data(),
                                          encoded.size(), compressor_.blosc_compressor, 0, 1);
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
    case Compressor::Kind::blosc: {
      std::size_t size = 0;
      if (blosc_cbuffer_validate(encoded.data(), encoded.size(), &size) != 0 ||
          size != plain.size() || !is_made_by(compressor_.blosc_compressor, encoded) ||
          blosc_decompress_ctx(encoded.data(), plain.data(), plain.size(), 1) !=
              static_cast<int>(plain.size())) {
        throw SampleError("Blosc cannot decompress it");
      }
      return;
    }
    case Compressor::Kind::zstd:
      if (ZSTD_decompress(plain.data(), plain.size(), encoded.data(), encoded.size()) !=
          plain.size()) {
        throw SampleError("zstd cannot decompress it");
      }
      return;
  }
}

}  // namespace biotomy::reconstruct
