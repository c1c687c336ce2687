#include "tests/virtual_camera/photographed_job.hpp"

#include "sim/phantom/phantom.hpp"
#include "sim/physics/block.hpp"
#include "sim/physics/camera.hpp"

namespace biotomy::tests {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr double kFirstFaceUm = 1000.0;
constexpr double kBlownCleanMs = 2000.0;

class Photographer {
 public:
  explicit Photographer(const PhotographedJob& job)
      : job_(job),
        phantom_({.seed = kSeed,
                  .width_um = job.width * job.pixel_um,
                  .height_um = job.height * job.pixel_um}),
        optics_{.view = {.width = job.width, .height = job.height, .pixel_um = job.pixel_um}},
        camera_(kSeed, phantom_, kFirstFaceUm, optics_, {}),
        block_(kSeed, kFirstFaceUm, 0.3, {}) {}

  void grind(int layer) {
    block_.begin_pass(kFirstFaceUm + (layer - 1) * job_.layer_um);
    block_.cut_to(1.0);
    block_.blow(kBlownCleanMs);
  }

  cv::Mat take(double defocus_um) {
    sim::Scene scene{.block = block_, .lamp_on = true};
    scene.column_um = block_.mean_um() - optics_.column_offset_um + defocus_um;
    return camera_.take(scene, scene, {}).image;
  }

 private:
  const PhotographedJob& job_;
  sim::Phantom phantom_;
  sim::CameraOptics optics_;
  sim::Camera camera_;
  sim::Block block_;
};

}  // namespace

JobPictures photograph(const PhotographedJob& job) {
  Photographer photographer(job);
  JobPictures pictures;
  pictures.all.push_back(photographer.take(job.focus_guess_error_um));
  const auto search = [&](double around_um) {
    const double middle = 0.5 * (job.focus_points - 1);
    for (int point = 0; point < job.focus_points; ++point) {
      pictures.all.push_back(photographer.take(around_um + (point - middle) * job.focus_step_um));
    }
    pictures.all.push_back(photographer.take(0.0));
  };
  for (int layer = 1; layer <= job.layers; ++layer) {
    photographer.grind(layer);
    if (layer == 1) search(job.focus_guess_error_um);
    if (layer == job.second_search_layer) search(0.0);
    pictures.of_layer.push_back(pictures.all.size());
    pictures.all.push_back(photographer.take(0.0));
  }
  return pictures;
}

}  // namespace biotomy::tests
