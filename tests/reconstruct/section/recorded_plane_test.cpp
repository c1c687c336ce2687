#include "reconstruct/section/recorded_plane.hpp"

#include <random>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/section/section_image.hpp"
#include "reconstruct/section/section_record.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;

class RecordedPlane : public testing::Test {
 protected:
  std::string error() const {
    return message_of<SampleError>([&] { recorded_plane(path_); });
  }
  void write(const std::string& text) const { write_text(path_, text); }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.json";
};

TEST_F(RecordedPlane, IsToTheBitTheOneOfTheSidecarAndOfThePictures) {
  const Cuboid cuboid{{41, 31, 21}, {10.0, 10.0, 20.0}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    const Plane plane = Plane::from_normal({number(random), number(random), number(random)},
                                           0.5 * cuboid.extent() + Vector3{number(random), 0, 0});
    const SectionOutline outline =
        outline_section(cuboid, 8, {plane, section_basis(BasisKind::layer, plane), {}});
    const SectionRecord record{"knee", cuboid, plane, outline, {12, 9}, {0, 0}, {0}, {}};
    write(json_text(to_json(record), 2));
    write_section_image(folder_ / "a.png", test_image(12, 9), picture_notes(record), 90);
    write_section_image(folder_ / "a.tif", test_image(12, 9), picture_notes(record), 90);
    for (const char* name : {"a.json", "a.png", "a.tif"}) {
      const Plane read = recorded_plane(folder_ / name);
      EXPECT_EQ(read.normal(), plane.normal()) << name;
      EXPECT_EQ(read.offset(), plane.offset()) << name;
    }
  }
}

TEST_F(RecordedPlane, NamesAFileThatHasNone) {
  for (const char* text : {"{}", "[]", "3", R"({"plane": {"normal": [0, 0], "offset_um": 1}})",
                           R"({"plane": {"normal": [0, 0, 0], "offset_um": 1}})",
                           R"({"plane": {"normal": [0, "1", 0], "offset_um": 1}})",
                           R"({"plane": {"normal": [0, 0, 1]}})"}) {
    write(text);
    EXPECT_THAT(error(), HasSubstr(path_.string() + ": does not say along which plane")) << text;
  }
  path_ = folder_ / "a.png";
  for (const char* description : {"", "a knee"}) {
    write_section_image(path_, test_image(12, 9), {10.0, "knee", description}, 90);
    EXPECT_THAT(error(), HasSubstr(path_.string() + ": does not say along which plane"));
  }
}

TEST_F(RecordedPlane, NamesAFileThatIsGoneOrNoJson) {
  EXPECT_THAT(error(), HasSubstr(path_.string() + ": there is no such file"));
  write("{\"plane\": ");
  EXPECT_THAT(error(), HasSubstr(path_.string() + ": it is not JSON"));
}

}  // namespace
}  // namespace biotomy::reconstruct
