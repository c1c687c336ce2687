#include "reconstruct/sample/layer_files_state.hpp"

#include <chrono>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

TEST(LayerFilesState, IsAnotherWhenOneOfTheLayersIs) {
  const tests::TemporaryFolder folder;
  SampleDescription description;
  description.name = "sample";
  description.cuboid = {{4, 4, 3}, {1.0, 1.0, 1.0}};
  const SampleFolder sample = SampleFolder::create(folder / "sample", description);
  for (int layer = 1; layer <= 3; ++layer) {
    write_text(sample.layer_path(layer), "an image");
  }
  const auto state = [&] { return layer_files_state(sample, 2); };
  const std::string before = state();
  EXPECT_EQ(state(), before);
  EXPECT_NE(layer_files_state(sample, 3), before);

  const auto written = std::filesystem::last_write_time(sample.layer_path(2));
  std::filesystem::last_write_time(sample.layer_path(3), written + std::chrono::seconds(1));
  EXPECT_EQ(state(), before);  // of a layer beyond
  std::filesystem::last_write_time(sample.layer_path(2), written + std::chrono::seconds(1));
  EXPECT_NE(state(), before);
  std::filesystem::last_write_time(sample.layer_path(2), written);
  EXPECT_EQ(state(), before);
  write_text(sample.layer_path(2), "a larger image");
  std::filesystem::last_write_time(sample.layer_path(2), written);
  EXPECT_NE(state(), before);
  std::filesystem::remove(sample.layer_path(2));
  EXPECT_NE(state(), before);
}

}  // namespace
}  // namespace biotomy::reconstruct
