#include "reconstruct/export/volume_block.hpp"

#include <algorithm>
#include <cstddef>

#include <opencv2/core.hpp>

namespace biotomy::reconstruct {
namespace {

cv::Rect face_of(const VoxelRegion& region) {
  return {static_cast<int>(region.x.first), static_cast<int>(region.y.first),
          static_cast<int>(region.x.count()), static_cast<int>(region.y.count())};
}

}  // namespace

std::vector<cv::Mat> read_block(const Volume& volume, int level, const VoxelRegion& region) {
  const auto& chunk = volume.layout().chunk;
  const int type = volume.bits() == 8 ? CV_8UC3 : CV_16UC3;
  const cv::Rect face = face_of(region);
  std::vector<cv::Mat> layers(static_cast<std::size_t>(region.z.count()));
  for (cv::Mat& layer : layers) {
    layer = cv::Mat(face.size(), type, cv::Scalar::all(0));
  }
  const int first_z = static_cast<int>(region.z.first);
  const int end_z = static_cast<int>(region.z.end);
  for (int cz = first_z / chunk[0]; cz * chunk[0] < end_z; ++cz) {
    for (int cy = face.y / chunk[1]; cy * chunk[1] < face.br().y; ++cy) {
      for (int cx = face.x / chunk[2]; cx * chunk[2] < face.br().x; ++cx) {
        const auto voxels = volume.read_chunk(level, {cz, cy, cx});
        if (!voxels) {
          continue;
        }
        const cv::Rect place(cx * chunk[2], cy * chunk[1], chunk[2], chunk[1]);
        const cv::Rect inside = place & face;
        const std::size_t plane = voxels->size() / static_cast<std::size_t>(chunk[0]);
        const int last = std::min(end_z, (cz + 1) * chunk[0]);
        for (int z = std::max(first_z, cz * chunk[0]); z < last; ++z) {
          auto* data = const_cast<std::byte*>(voxels->data()) +  // cv::Mat knows no const
                       plane * static_cast<std::size_t>(z - cz * chunk[0]);
          cv::Mat(place.size(), type, data)(inside - place.tl())
              .copyTo(layers[static_cast<std::size_t>(z - first_z)](inside - face.tl()));
        }
      }
    }
  }
  return layers;
}

}  // namespace biotomy::reconstruct
