#include "tests/quality/phantom_sequence.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/physics/defocus.hpp"

namespace biotomy::tests {
namespace {

constexpr double kFirstFaceUm = 1000.0;  // the feed at which z = 0 of the phantom lies

// Within a quarter of the depth of field together, at the end of a period.
constexpr double kFocusJitterUm = 5.0;
constexpr double kFocusDriftUm = 0.9;  // a layer
constexpr double kLampJitter = 0.01;
constexpr double kLampDrift = 0.001;  // a layer
constexpr double kPlaceJitterPixels = 0.4;

constexpr double kBlownCleanMs = 1000.0;
constexpr double kMostDebris = 0.06;  // of the frame, before any air

sim::PhantomSettings specimen(const SequenceSettings& s) {
  return {.seed = s.seed,
          .width_um = s.width * s.pixel_um,
          .height_um = s.height * s.pixel_um,
          .depth_um = s.depth_layers * s.layer_um,
          .detail_um = s.detail_pixels * s.pixel_um,
          .begins_um = s.begins_at_layer * s.layer_um,
          .ends_um = s.ends_at_layer * s.layer_um,
          .end_um = s.end_layers * s.layer_um};
}

/// Chips of 4 to 12 pixels, as many as would cover kMostDebris of the frame.
sim::DebrisSettings chips(const SequenceSettings& s) {
  const double radius = 4.0 + 8.0 * static_cast<double>(sim::mixed_fraction(s.seed, 77));
  constexpr double kMeanSquare = 0.463;  // of radii from 0.3 to 1 of the largest
  const double area = kMeanSquare * std::numbers::pi * radius * radius;
  return {.specks = static_cast<int>(kMostDebris * s.width * s.height / area),
          .radius_um = radius * s.pixel_um,
          .hold_ms = kBlownCleanMs};
}

/// The part of the frame that chips cover, those that overlap counted twice.
double debris_share(const sim::Block& block, const sim::View& view) {
  double pixels = 0.0;
  for (const sim::Speck& speck : block.debris()) {
    const double radius = static_cast<double>(speck.radius_um) / view.pixel_um;
    pixels += std::numbers::pi * radius * radius;
  }
  return pixels / view.width / view.height;
}

double clipped_share(const cv::Mat& image) {
  cv::Mat most;
  cv::reduce(image.reshape(1, static_cast<int>(image.total())), most, 1, cv::REDUCE_MAX);
  return cv::countNonZero(most == 255) / static_cast<double>(image.total());
}

Demand demand_of(const DefectKind& kind, double strength) {
  return strength >= kind.harmful    ? Demand::reject
         : strength <= kind.harmless ? Demand::accept
                                     : Demand::either;
}

}  // namespace

PhantomSequence::PhantomSequence(const SequenceSettings& settings)
    : settings_(settings),
      drawn_(settings.seed ^ 0x6c6162656cU),
      phantom_(specimen(settings)),
      optics_{.view = {.width = settings.width,
                       .height = settings.height,
                       .pixel_um = settings.pixel_um}},
      camera_(settings.seed, phantom_, kFirstFaceUm, optics_, {.mosaic = settings.mosaic}),
      block_(settings.seed, kFirstFaceUm, 0.0, chips(settings)),
      focus_drift_um_(drawn_.between(-kFocusDriftUm, kFocusDriftUm)),
      lamp_drift_(drawn_.between(-kLampDrift, kLampDrift)) {}

PhantomSequence::Setting PhantomSequence::well(const sim::Block& block) {
  Setting setting{.scene = {.block = block, .lamp_on = true}};
  setting.scene.displacement = displacement_;
  setting.scene.lamp_share = 1.0 + lamp_drift_ * layer_ + drawn_.between(-kLampJitter, kLampJitter);
  const int since_bracket = (layer_ - 1) % settings_.focus_period;
  setting.defocus_um =
      focus_drift_um_ * since_bracket + drawn_.between(-kFocusJitterUm, kFocusJitterUm);
  return setting;
}

bridge::Frame PhantomSequence::photograph(const Setting& setting) {
  sim::Scene begin = setting.scene;
  begin.column_um = begin.block.mean_um() - setting.defocus_um - optics_.column_offset_um;
  sim::Scene end = begin;
  begin.traverse_um -= 0.5 * setting.smear_pixels * settings_.pixel_um;
  end.traverse_um += 0.5 * setting.smear_pixels * settings_.pixel_um;
  sim::ExposureSettings exposure;
  exposure.exposure_us *= setting.exposure;
  sim::Photograph taken = camera_.take(begin, end, exposure);
  return {.image = std::move(taken.image),
          .sequence = taken.number,
          .sensor_timestamp = std::chrono::milliseconds(100 * taken.number)};
}

double PhantomSequence::contrast(const Setting& setting) const {
  const auto after_blur = [&](double defocus_um) {
    const double sigma_um = sim::blur_sigma_um(optics_.lens, defocus_um);
    return sim::contrast_at_half_nyquist(sim::blur_weights(sigma_um / settings_.pixel_um));
  };
  return after_blur(setting.defocus_um) / after_blur(0.0) *
         sim::contrast_at_half_nyquist(sim::smear_weights(setting.smear_pixels));
}

/// One frame of seven is harmless and two are in the grey zone, where there are such.
double PhantomSequence::strength_of(const DefectKind& kind) {
  const int drawn = drawn_.below(7);
  if (drawn == 0 && kind.harmless > kind.least) {
    return drawn_.between_ratios(kind.least, kind.harmless);
  }
  if (drawn <= 2 && kind.harmful > kind.least) {
    return drawn_.between_ratios(std::max(kind.harmless, kind.least), kind.harmful);
  }
  return drawn_.between_ratios(kind.harmful, kind.most);
}

/// All kinds come as often as their weights say, in an order drawn anew.
Defect PhantomSequence::next_defect() {
  if (to_come_.empty()) {
    for (const DefectKind& kind : defect_kinds()) {
      to_come_.insert(to_come_.end(), static_cast<std::size_t>(kind.weight), kind.defect);
    }
    for (std::size_t i = to_come_.size(); i > 1; --i) {
      std::swap(to_come_[i - 1],
                to_come_[static_cast<std::size_t>(drawn_.below(static_cast<int>(i)))]);
    }
  }
  const Defect next = to_come_.back();
  to_come_.pop_back();
  return next;
}

/// The face of the layer before, photographed again.
LabelledFrame PhantomSequence::unchanged() {
  const Setting setting = well(block_);
  return {.frame = photograph(setting),
          .defect = Defect::unchanged,
          .strength = 1.0,
          .contrast = contrast(setting),
          .demand = Demand::reject};
}

LabelledFrame PhantomSequence::defective(Defect defect, const sim::Block& clean,
                                         const sim::Block& dirty) {
  const DefectKind& kind = kind_of(defect);
  LabelledFrame made{.defect = defect, .strength = strength_of(kind)};
  const double part = 0.01 * made.strength;
  Setting setting = well(clean);
  sim::Scene& scene = setting.scene;
  switch (defect) {
    case Defect::defocus:
    case Defect::part_blurred: {
      const double spread_pixels = std::sqrt(-std::log(1.0 - part));
      const double confusion_um = 4.0 * spread_pixels * settings_.pixel_um;
      setting.defocus_um = drawn_.sign() * confusion_um / (2.0 * optics_.lens.numerical_aperture);
      break;
    }
    case Defect::smear:
      // Up to 3 pixels the contrast is one part in the length; beyond 4 it is gone, or inverted.
      setting.smear_pixels = part < 2.0 / 3.0 ? 1.0 / (1.0 - part) : drawn_.between(3.0, 6.0);
      break;
    case Defect::lamp_dark:
      scene.lamp_share *= 1.0 - part;
      break;
    case Defect::lamp_bright:
      scene.lamp_share *= 1.0 + part;
      break;
    case Defect::uneven_light: {
      const double angle = drawn_.between(0.0, 2.0 * std::numbers::pi);
      scene.lamp_field.slope_x = part * std::cos(angle);
      scene.lamp_field.slope_y = part * std::sin(angle);
      break;
    }
    case Defect::clipped:
      setting.exposure = drawn_.between(1.05, 1.6);
      break;
    case Defect::colour_cast:
      scene.lamp_field.colour.at(static_cast<std::size_t>(drawn_.below(3))) += drawn_.sign() * part;
      break;
    case Defect::debris: {
      scene.block = dirty;
      const double all = debris_share(dirty, optics_.view);
      scene.block.blow(kBlownCleanMs * std::max(0.0, 1.0 - part / all));
      made.strength = 100.0 * debris_share(scene.block, optics_.view);
      break;
    }
    case Defect::frost:
      scene.film.frost = {.share = drawn_.between_ratios(0.1, 0.6), .opacity = part};
      break;
    case Defect::glare:
      scene.film.glare.share = part;
      break;
    case Defect::part_unchanged:
      scene.block = block_;
      scene.block.begin_pass(clean.mean_um());
      scene.block.cut_to(1.0 - part);
      scene.block.blow(kBlownCleanMs);
      break;
    case Defect::shift: {
      const double angle = drawn_.between(0.0, 2.0 * std::numbers::pi);
      scene.displacement.x_um += made.strength * settings_.pixel_um * std::cos(angle);
      scene.displacement.y_um += made.strength * settings_.pixel_um * std::sin(angle);
      break;
    }
    default:
      break;
  }
  made.contrast = contrast(setting);
  made.frame = photograph(setting);
  if (defect == Defect::part_blurred) {
    const bridge::Frame sharp = photograph(well(clean));
    sharp.image.copyTo(made.frame.image, ~part_of_frame(drawn_.between(0.15, 0.5)));
  }
  spoil(made);
  if (defect == Defect::clipped) {
    made.strength = 100.0 * (clipped_share(made.frame.image) - clipped_share(accepted_.image));
  } else if (defect == Defect::defocus || defect == Defect::smear ||
             defect == Defect::part_blurred) {
    made.strength = 100.0 * (1.0 - made.contrast);
  }
  made.demand = demand_of(kind, made.strength);
  return made;
}

/// 255 in so large a part of the frame: along an edge, or a disc.
cv::Mat PhantomSequence::part_of_frame(double share) {
  cv::Mat mask = cv::Mat::zeros(settings_.height, settings_.width, CV_8UC1);
  const int width = static_cast<int>(std::lround(share * mask.cols));
  const int height = static_cast<int>(std::lround(share * mask.rows));
  const std::array strips = {
      cv::Rect(0, 0, width, mask.rows), cv::Rect(mask.cols - width, 0, width, mask.rows),
      cv::Rect(0, 0, mask.cols, height), cv::Rect(0, mask.rows - height, mask.cols, height)};
  const auto drawn = static_cast<std::size_t>(drawn_.below(static_cast<int>(strips.size()) + 1));
  if (drawn < strips.size()) {
    mask(strips.at(drawn)).setTo(255);
    return mask;
  }
  // Of 40 % of a frame of 4 : 3 a disc still lies within it.
  const double area = std::min(share, 0.4) * static_cast<double>(mask.total());
  const int radius = static_cast<int>(std::sqrt(area / std::numbers::pi));
  const cv::Point centre(static_cast<int>(drawn_.between(radius, mask.cols - radius)),
                         static_cast<int>(drawn_.between(radius, mask.rows - radius)));
  cv::circle(mask, centre, radius, cv::Scalar::all(255), cv::FILLED);
  return mask;
}

/// Less light in a part of the frame, with an edge that is hard or soft.
void PhantomSequence::shade(cv::Mat& image, double part) {
  cv::Mat light;
  part_of_frame(drawn_.between(0.08, 0.4)).convertTo(light, CV_32FC1, -part / 255.0, 1.0);
  const double soft = drawn_.below(2) == 0 ? 0.0 : drawn_.between(2.0, 40.0);
  if (soft > 0.0) cv::GaussianBlur(light, light, {}, soft);
  cv::Mat colours;
  cv::merge(std::array{light, light, light}, colours);
  cv::multiply(image, colours, image, 1.0, image.type());
}

/// What happens to the picture after it was taken, or could be done to it in front of the lens.
void PhantomSequence::spoil(LabelledFrame& made) {
  cv::Mat& image = made.frame.image;
  const int rows = static_cast<int>(std::lround(0.01 * made.strength * image.rows));
  const cv::Range last(image.rows - std::clamp(rows, 1, image.rows), image.rows);
  switch (made.defect) {
    case Defect::torn:
      accepted_.image.rowRange(last).copyTo(image.rowRange(last));
      break;
    case Defect::shadow:
      shade(image, 0.01 * made.strength);
      break;
    case Defect::partial:
      image.rowRange(last).setTo(cv::Scalar::all(0));
      break;
    case Defect::black:
      image.setTo(cv::Scalar::all(0));
      break;
    case Defect::stale:
      image = accepted_.image.clone();
      if (drawn_.below(2) == 0) {
        made.frame.sequence = accepted_.sequence;
        made.frame.sensor_timestamp = accepted_.sensor_timestamp;
      }
      break;
    default:
      break;
  }
}

std::optional<LabelledLayer> PhantomSequence::next() {
  if (layer_ == settings_.layers) return std::nullopt;
  LabelledLayer made{.layer = ++layer_};
  std::vector<Defect> defects;
  for (int i = 0; i < settings_.defects_per_layer && layer_ >= settings_.first_defect_layer; ++i) {
    defects.push_back(next_defect());
  }
  // Before the block is ground, and while the camera still has the face that it shows.
  for (const Defect defect : defects) {
    if (defect == Defect::unchanged) made.defective.push_back(unchanged());
  }

  displacement_ = {drawn_.between(-kPlaceJitterPixels, kPlaceJitterPixels) * settings_.pixel_um,
                   drawn_.between(-kPlaceJitterPixels, kPlaceJitterPixels) * settings_.pixel_um};
  sim::Block dirty = block_;
  dirty.begin_pass(kFirstFaceUm + settings_.layer_um * (layer_ - 1));
  dirty.cut_to(1.0);
  sim::Block clean = dirty;
  clean.blow(2.0 * kBlownCleanMs);

  if ((layer_ - 1) % settings_.focus_period == 0) {
    Setting setting = well(clean);
    setting.defocus_um = drawn_.between(-kFocusJitterUm, kFocusJitterUm);
    made.bracket = photograph(setting);
  }
  const Setting setting = well(clean);
  made.good = {.frame = photograph(setting), .contrast = contrast(setting)};
  for (const Defect defect : defects) {
    if (defect != Defect::unchanged) made.defective.push_back(defective(defect, clean, dirty));
  }
  block_ = clean;
  accepted_ = made.good.frame;
  return made;
}

}  // namespace biotomy::tests
