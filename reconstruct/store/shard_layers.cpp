#include "reconstruct/store/shard_layers.hpp"

#include <algorithm>
#include <cstddef>

#include "reconstruct/store/codecs.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {

std::vector<cv::Mat> shard_layers(const std::optional<StoredShard>& shard, const ZarrArray& array,
                                  int first, int count, cv::Size size) {
  const int type = array.bits == 8 ? CV_8UC3 : CV_16UC3;
  std::vector<cv::Mat> layers(static_cast<std::size_t>(count));
  for (cv::Mat& layer : layers) {
    layer = cv::Mat(size, type, cv::Scalar::all(0));
  }
  if (!shard) {
    return layers;
  }
  const auto& chunk = array.layout.chunk;
  const BlockCount chunks = chunks_of_shard(array.layout);
  const ChunkCodec codec(array.layout, array.bits);
  const cv::Rect face(cv::Point(0, 0), size);
  const auto put_chunk = [&](std::size_t number) {
    const auto place = static_cast<std::int64_t>(number);
    const int z = static_cast<int>(place / (chunks.x * chunks.y)) * chunk[0];
    const cv::Rect inside =
        cv::Rect(static_cast<int>(place % chunks.x) * chunk[2],
                 static_cast<int>(place / chunks.x % chunks.y) * chunk[1], chunk[2], chunk[1]) &
        face;
    const int begin = std::max(first, z);
    const int end = std::min(first + count, z + chunk[0]);
    if (inside.empty() || begin >= end || !shard->stores(number)) {
      return;
    }
    std::vector<std::byte> voxels(codec.chunk_bytes());
    shard->decode(number, codec, voxels);
    const std::size_t plane = voxels.size() / static_cast<std::size_t>(chunk[0]);
    for (int layer = begin; layer < end; ++layer) {
      cv::Mat(chunk[1], chunk[2], type,
              voxels.data() + plane * static_cast<std::size_t>(layer - z))(
          cv::Rect(cv::Point(0, 0), inside.size()))
          .copyTo(layers[static_cast<std::size_t>(layer - first)](inside));
    }
  };
  whole_loop(static_cast<std::size_t>(chunks.total()), put_chunk);
  return layers;
}

}  // namespace biotomy::reconstruct
