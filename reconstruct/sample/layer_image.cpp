#include "reconstruct/sample/layer_image.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numeric>
#include <vector>

#include <nlohmann/json.hpp>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <zlib.h>
#include <zstd.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/tiff_file.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kTile = 256;
constexpr int kChannels = 3;
constexpr double kMicrometresPerCentimetre = 10'000.0;

using Bytes = std::vector<std::byte>;

/// The tile at (x, y), each value replaced by its difference from the same colour of the pixel on
/// its left (TIFF 6.0, section 14: predictor 2). Beyond the border the last pixel goes on, which
/// costs nothing after the prediction.
template <typename Sample>
void predict_tile(const cv::Mat& image, int x, int y, Bytes& bytes) {
  auto* out = reinterpret_cast<Sample*>(bytes.data());
  const int columns = std::min(kTile, image.cols - x);
  for (int row = 0; row < kTile; ++row, out += kTile * kChannels) {
    const auto* in = image.ptr<Sample>(std::min(y + row, image.rows - 1)) +
                     static_cast<std::ptrdiff_t>(x) * kChannels;
    std::copy_n(in, kChannels, out);
    for (int i = kChannels; i < columns * kChannels; ++i) {
      out[i] = static_cast<Sample>(in[i] - in[i - kChannels]);
    }
    std::fill(out + columns * kChannels, out + kTile * kChannels, Sample{0});
  }
}

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

/// Compresses one tile after the other; what it works with is kept from tile to tile.
class TileEncoder {
 public:
  TileEncoder(const cv::Mat& image, const LayerFormat& format)
      : image_(image),
        format_(format),
        plain_(std::size_t{kTile} * kTile * kChannels * image.elemSize1()) {
    if (format.compression != LayerCompression::zstd) {
      encoded_.resize(compressBound(plain_.size()));
      return;
    }
    encoded_.resize(ZSTD_compressBound(plain_.size()));
    context_.reset(ZSTD_createCCtx());
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, format.level);
    // What the predictor leaves of a photograph is noise, in which matches are chance. Short ones
    // cost more than they save: without those below 7 bytes, noise takes 0.4 of the time and 1 %
    // less room, and pictures without noise what they took before.
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_minMatch, 7);
    // A table of matches that stays in the nearest cache: noise takes 0.75 of the time, pictures
    // 0.9 and up to 1 % more room.
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_hashLog, 12);
    // zstd's own checksum of four bytes, so that whoever reads the layer notices a changed byte.
    // (Deflate has one as well, but libtiff does not look at it.)
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
  }

  Bytes encode(int x, int y) {
    if (image_.depth() == CV_8U) {
      predict_tile<std::uint8_t>(image_, x, y, plain_);
    } else {
      predict_tile<std::uint16_t>(image_, x, y, plain_);
    }
    const std::size_t size = context_ ? compress_zstd() : compress_deflate();
    return {encoded_.begin(), encoded_.begin() + static_cast<std::ptrdiff_t>(size)};
  }

 private:
  std::size_t compress_zstd() {
    const std::size_t size = ZSTD_compress2(context_.get(), encoded_.data(), encoded_.size(),
                                            plain_.data(), plain_.size());
    if (ZSTD_isError(size) != 0) {
      throw SampleError(std::string("zstd cannot compress a tile: ") + ZSTD_getErrorName(size));
    }
    return size;
  }

  std::size_t compress_deflate() {
    uLongf size = encoded_.size();
    if (compress2(reinterpret_cast<Bytef*>(encoded_.data()), &size,
                  reinterpret_cast<const Bytef*>(plain_.data()), plain_.size(),
                  format_.level) != Z_OK) {
      throw SampleError("zlib cannot compress a tile");
    }
    return size;
  }

  const cv::Mat& image_;
  const LayerFormat& format_;
  std::unique_ptr<ZSTD_CCtx, FreeContext> context_;  ///< none for deflate
  Bytes plain_;
  Bytes encoded_;
};

std::vector<Bytes> encode_tiles(const cv::Mat& image, const LayerFormat& format) {
  const int across = (image.cols + kTile - 1) / kTile;
  const int down = (image.rows + kTile - 1) / kTile;
  std::vector<Bytes> tiles(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  tbb::enumerable_thread_specific<TileEncoder> encoders([&] { return TileEncoder(image, format); });
  whole_loop(tiles.size(), [&](std::size_t number) {
    const int x = static_cast<int>(number % static_cast<std::size_t>(across)) * kTile;
    const int y = static_cast<int>(number / static_cast<std::size_t>(across)) * kTile;
    tiles[number] = encoders.local().encode(x, y);
  });
  return tiles;
}

void write_tags(TiffFile& file, const cv::Mat& image, const LayerPosition& position,
                const LayerFormat& format) {
  file.set(TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(image.cols));
  file.set(TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(image.rows));
  file.set(TIFFTAG_TILEWIDTH, static_cast<std::uint32_t>(kTile));
  file.set(TIFFTAG_TILELENGTH, static_cast<std::uint32_t>(kTile));
  file.set(TIFFTAG_SAMPLESPERPIXEL, kChannels);
  file.set(TIFFTAG_BITSPERSAMPLE, image.depth() == CV_8U ? 8 : 16);
  file.set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  file.set(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  file.set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  file.set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  file.set(TIFFTAG_COMPRESSION, format.compression == LayerCompression::zstd
                                    ? COMPRESSION_ZSTD
                                    : COMPRESSION_ADOBE_DEFLATE);
  file.set(TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  file.set(TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
  file.set(TIFFTAG_XRESOLUTION, kMicrometresPerCentimetre / position.spacing.x);
  file.set(TIFFTAG_YRESOLUTION, kMicrometresPerCentimetre / position.spacing.y);
  const nlohmann::json description = {
      {"layer", position.layer},
      {"z_um", static_cast<double>(position.layer - 1) * position.spacing.z},
      {"spacing_um", {position.spacing.x, position.spacing.y, position.spacing.z}}};
  file.set(TIFFTAG_IMAGEDESCRIPTION, description.dump().c_str());
  file.set(TIFFTAG_SOFTWARE, "Biotomy " BIOTOMY_VERSION);
}

}  // namespace

Bytes encode_layer_image(const std::filesystem::path& path, const cv::Mat& image,
                         const LayerPosition& position, const LayerFormat& format) {
  if (image.empty() || (image.type() != CV_8UC3 && image.type() != CV_16UC3)) {
    throw SampleError(path.string() + ": a layer image must be RGB of 8 or 16 bits");
  }
  std::vector<Bytes> tiles = encode_tiles(image, format);
  const std::uint64_t size =
      std::accumulate(tiles.begin(), tiles.end(), std::uint64_t{0},
                      [](std::uint64_t sum, const Bytes& tile) { return sum + tile.size(); });
  // The tags and the tables of tiles come on top: 16 bytes a tile at most, and some change.
  const std::uint64_t with_tables = size + 16 * tiles.size() + 4096;

  Bytes memory;
  memory.reserve(with_tables);
  TiffFile file = TiffFile::create(memory, with_tables > format.largest_classic_tiff, path);
  write_tags(file, image, position, format);
  for (std::size_t number = 0; number < tiles.size(); ++number) {
    Bytes& tile = tiles[number];
    const auto tile_size = static_cast<tmsize_t>(tile.size());
    if (TIFFWriteRawTile(file.get(), static_cast<std::uint32_t>(number), tile.data(), tile_size) !=
        tile_size) {
      file.fail("cannot put its tiles together");
    }
    tile = {};  // the file in memory has it now
  }
  file.finish();
  return memory;
}

PublishLayer prepare_layer_image(const std::filesystem::path& path, const cv::Mat& image,
                                 const LayerPosition& position, const LayerFormat& format) {
  auto file =
      std::make_shared<VerifiedFile>(path, encode_layer_image(path, image, position, format));
  return [file] {
    file->publish();
    return StoredLayer{file->bytes(), file->sha256()};
  };
}

StoredLayer write_layer_image(const std::filesystem::path& path, const cv::Mat& image,
                              const LayerPosition& position, const LayerFormat& format) {
  return prepare_layer_image(path, image, position, format)();
}

}  // namespace biotomy::reconstruct
