#include "reconstruct/export/tiff_stack.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <zlib.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/export/unfinished_export.hpp"
#include "reconstruct/export/volume_block.hpp"
#include "reconstruct/export/voxel_region.hpp"
#include "reconstruct/picture/tiff_file.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr int kChannels = 3;
constexpr int kDeflateLevel = 6;
constexpr double kMicrometresPerCentimetre = 10'000.0;
constexpr std::uint64_t kLargestClassicTiff = 0xF0000000;  // a TIFF ends at 4 GiB
constexpr std::int64_t kMostOpenFiles = 256;  // a chunk may have more layers than these

using Bytes = std::vector<std::byte>;

std::string layer_name(std::int64_t layer) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06lld.tif", static_cast<long long>(layer + 1));
  return name.data();
}

/// The distance of layers, which TIFF has no tag for, as ImageJ writes and reads it; readers know
/// its text by the version that it begins with. ImageJ then takes the resolution in micrometres
/// too.
std::string layer_distance(double micrometres) {
  std::array<char, 32> number{};
  std::to_chars(number.data(), number.data() + number.size(), micrometres);
  return std::string("ImageJ=1.53t\nunit=um\nspacing=") + number.data() + '\n';
}

TiffFile create_layer(const fs::path& path, const VoxelRegion& region, const PyramidLevel& level,
                      int bits, int rows_of_a_strip) {
  const auto bytes = static_cast<std::uint64_t>(region.x.count() * region.y.count()) * kChannels *
                     static_cast<std::uint64_t>(bits / 8);
  TiffFile file = TiffFile::create_on_disk(path, bytes > kLargestClassicTiff);
  file.set(TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(region.x.count()));
  file.set(TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(region.y.count()));
  file.set(TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows_of_a_strip));
  file.set(TIFFTAG_SAMPLESPERPIXEL, kChannels);
  file.set(TIFFTAG_BITSPERSAMPLE, bits);
  file.set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  file.set(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  file.set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  file.set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  file.set(TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  file.set(TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
  file.set(TIFFTAG_XRESOLUTION, kMicrometresPerCentimetre / level.spacing.x);
  file.set(TIFFTAG_YRESOLUTION, kMicrometresPerCentimetre / level.spacing.y);
  file.set(TIFFTAG_IMAGEDESCRIPTION, layer_distance(level.spacing.z).c_str());
  file.set(TIFFTAG_SOFTWARE, "Biotomy " BIOTOMY_VERSION);
  return file;
}

Bytes compress(const cv::Mat& strip) {
  const std::size_t size = strip.total() * strip.elemSize();
  uLongf encoded_size = compressBound(size);
  Bytes encoded(encoded_size);
  if (compress2(reinterpret_cast<Bytef*>(encoded.data()), &encoded_size, strip.ptr(), size,
                kDeflateLevel) != Z_OK) {
    throw SampleError("zlib cannot compress a strip");
  }
  encoded.resize(encoded_size);
  return encoded;
}

/// The part of a row of chunks in one column of chunks.
std::vector<VoxelRegion> columns_of(const VoxelRegion& row, std::int64_t width) {
  std::vector<VoxelRegion> columns;
  for (std::int64_t x = row.x.first; x < row.x.end;) {
    const std::int64_t end = std::min((x / width + 1) * width, row.x.end);
    columns.push_back({{x, end}, row.y, row.z});
    x = end;
  }
  return columns;
}

/// A region, whose columns are read in parallel.
std::vector<cv::Mat> read_row(const Volume& volume, int level, const VoxelRegion& row) {
  std::vector<cv::Mat> layers(static_cast<std::size_t>(row.z.count()));
  for (cv::Mat& layer : layers) {
    layer.create(static_cast<int>(row.y.count()), static_cast<int>(row.x.count()),
                 volume.bits() == 8 ? CV_8UC3 : CV_16UC3);
  }
  const auto columns = columns_of(row, volume.layout().chunk[2]);
  whole_loop(columns.size(), [&](std::size_t i) {
    const std::vector<cv::Mat> part = read_block(volume, level, columns[i]);
    const cv::Range place(static_cast<int>(columns[i].x.first - row.x.first),
                          static_cast<int>(columns[i].x.end - row.x.first));
    for (std::size_t k = 0; k < layers.size(); ++k) {
      part[k].copyTo(layers[k].colRange(place));
    }
  });
  return layers;
}

/// Layers that lie in the same chunks, written together.
void write_slab(const Volume& volume, const ExportRequest& request, const VoxelRegion& slab,
                const fs::path& folder) {
  const int rows = volume.layout().chunk[1];
  std::vector<TiffFile> files;
  for (std::int64_t z = slab.z.first; z < slab.z.end; ++z) {
    files.push_back(create_layer(folder / layer_name(z), slab, volume.level(request.level),
                                 volume.bits(), rows));
  }
  std::uint32_t strip = 0;
  for (std::int64_t y = slab.y.first; y < slab.y.end; y += rows, ++strip) {
    stop_here_if(request.stop, "the export was interrupted; nothing is left of it");
    const VoxelRange part{y, std::min(y + rows, slab.y.end)};
    const auto layers = read_row(volume, request.level, {slab.x, part, slab.z});
    whole_loop(layers.size(), [&](std::size_t k) {
      Bytes encoded = compress(layers[k]);
      const auto size = static_cast<tmsize_t>(encoded.size());
      if (TIFFWriteRawStrip(files[k].get(), strip, encoded.data(), size) != size) {
        files[k].fail("cannot write it; is the disk full?");
      }
    });
  }
  for (TiffFile& file : files) {
    file.finish();
  }
}

}  // namespace

void export_tiff_stack(const Volume& volume, const ExportRequest& request) {
  const VoxelRegion region = exported_region(volume, request);
  UnfinishedExport unfinished(request.output);
  const std::int64_t depth = volume.layout().chunk[0];
  for (std::int64_t z = region.z.first; z < region.z.end;) {
    const std::int64_t end = std::min({(z / depth + 1) * depth, z + kMostOpenFiles, region.z.end});
    write_slab(volume, request, {region.x, region.y, {z, end}}, unfinished.folder());
    z = end;
    if (request.progress) {
      request.progress(z - region.z.first, region.z.count());
    }
  }
  unfinished.finish();
}

}  // namespace biotomy::reconstruct
