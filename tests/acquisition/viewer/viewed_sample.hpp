#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "acquisition/viewer/sample_api.hpp"
#include "reconstruct/picture/png_reader.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::acquisition {

/// A sample of 60 × 50 voxels and at most 40 layers, asked without a server.
class ViewedSample : public testing::Test {
 protected:
  static constexpr reconstruct::GridSize kSize{60, 50, 40};

  void add_layers(std::int64_t first, std::int64_t last) {
    reconstruct::add_layers(sample_, first, last);
  }

  /// Makes the volume of all layers that there are.
  void make_volume(std::int64_t layers) {
    reconstruct::VolumeWriter(sample_, {}).append(layers, layers == kSize.z);
  }

  ApiResponse ask(const std::string& path, std::map<std::string, std::string> query = {}) const {
    return api_.answer({.method = "GET", .path = path, .query = std::move(query)});
  }

  static nlohmann::json json_of(const ApiResponse& response) {
    return nlohmann::json::parse(response.body);
  }

  /// Of a PNG.
  static cv::Mat pixels_of(const ApiResponse& response) {
    return reconstruct::decode_png(std::as_bytes(std::span(response.body)));
  }

  static std::string sentence_of(const ApiResponse& response) {
    return json_of(response).at("error").at("message");
  }

  tests::TemporaryFolder folder_;
  reconstruct::SampleFolder sample_ =
      reconstruct::sample_with_layers(folder_ / "knee 042", kSize, 8, 0, {10.0, 11.0, 20.0});
  SampleApi api_{sample_.path(), {.cache_bytes = 10'000'000}};
};

}  // namespace biotomy::acquisition
