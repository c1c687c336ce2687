#include "acquisition/service/quality_section.hpp"

#include <string>

#include "acquisition/service/configuration_keys.hpp"

namespace biotomy::acquisition {
namespace {

using bridge::CheckedTable;
using bridge::TextKey;

void read_light_and_surface(const CheckedTable& table, QualityThresholds& thresholds) {
  thresholds.maximum_brightness_change =
      number(table, "maximum_brightness_change", thresholds.maximum_brightness_change, "", 0.0,
             10.0, "the light may be stronger or weaker than the last layers' by this part");
  thresholds.maximum_unevenness =
      number(table, "maximum_unevenness", thresholds.maximum_unevenness, "", 0.0, 10.0,
             "likewise, in one part of the frame against another");
  thresholds.maximum_colour_cast =
      number(table, "maximum_colour_cast", thresholds.maximum_colour_cast, "", 0.0, 10.0,
             "likewise, in one colour against another");
  thresholds.maximum_brightness_drift =
      number(table, "maximum_brightness_drift", thresholds.maximum_brightness_drift, "", 0.0, 10.0,
             "the casting material may be brighter or darker than in the first layer by this part");
  thresholds.maximum_colour_drift =
      number(table, "maximum_colour_drift", thresholds.maximum_colour_drift, "", 0.0, 10.0,
             "likewise, in one colour against another");
  thresholds.maximum_shift =
      number(table, "maximum_shift", thresholds.maximum_shift, "pixels", 0.0, 10000.0,
             "the block may lie beside where it lay in the last layer; beyond, it came loose");
  thresholds.maximum_debris =
      number(table, "maximum_debris", thresholds.maximum_debris, "", 0.0, 1.0,
             "part of the frame that may have colours that the last layers have nowhere near; 1: "
             "not judged");
  thresholds.maximum_frost = number(table, "maximum_frost", thresholds.maximum_frost, "", 0.0, 1.0,
                                    "part of the frame that may be under a whitish veil");
  thresholds.maximum_glare = number(table, "maximum_glare", thresholds.maximum_glare, "", 0.0, 1.0,
                                    "part of the frame that may reflect the lamp");
  thresholds.maximum_shade =
      number(table, "maximum_shade", thresholds.maximum_shade, "", 0.0, 1.0,
             "part of the frame that may be darker or brighter, in all colours alike, than its "
             "light makes it");
}

}  // namespace

LadderSettings::Exhausted exhausted_policy(const std::string& name) {
  return name == "accept" ? LadderSettings::Exhausted::accept : LadderSettings::Exhausted::pause;
}

void read_quality(const CheckedTable& table, QualityThresholds& thresholds,
                  LadderSettings& ladder) {
  ladder.max_attempts = count(table, "max_attempts", ladder.max_attempts, 1, 100,
                              "frames of a layer until a person is asked: take again, focus "
                              "again, clear again");
  const std::string policy = table.get(TextKey{
      .name = "policy",
      .fallback = "pause",
      .choices = {"pause", "accept"},
      .description = "when no attempt was good enough: pause the rig, or accept the sharpest with "
                     "a flag if it lacks nothing but sharpness"});
  ladder.exhausted = exhausted_policy(policy);
  ladder.flagged_in_a_row =
      count(table, "flagged_in_a_row", ladder.flagged_in_a_row, 1, 1000,
            "layers one after the other that are accepted with a flag; then the rig pauses, since "
            "a focus that is lost does not come back by grinding");
  thresholds.minimum_sharpness_ratio =
      number(table, "minimum_sharpness_ratio", thresholds.minimum_sharpness_ratio, "", 0.0, 10.0,
             "sharpness of a frame relative to this layer's focus search, or without one to the "
             "last layers; a blur that takes 15 % of the contrast at half the Nyquist frequency "
             "leaves 0.87");
  thresholds.minimum_sharpness_to_record =
      number(table, "minimum_sharpness_to_record", thresholds.minimum_sharpness_to_record, "", 0.0,
             10.0, "sharpness of a frame after a focus search, relative to the last layers");
  thresholds.minimum_sharpness_along_axis = number(
      table, "minimum_sharpness_along_axis", thresholds.minimum_sharpness_along_axis, "", 0.0, 10.0,
      "likewise as minimum_sharpness_ratio, along the less sharp of the two axes");
  thresholds.minimum_fine_contrast = number(
      table, "minimum_fine_contrast", thresholds.minimum_fine_contrast, "", 0.0, 10.0,
      "contrast of a frame's fine detail, where its colour is the same, relative to what its "
      "sharpness is compared with: for a blur that leaves nothing but noise");
  thresholds.maximum_blurred_part = number(
      table, "maximum_blurred_part", thresholds.maximum_blurred_part, "", 0.0, 1.0,
      "part of the frame, in one piece, that may be clearly less sharp than the last layers were "
      "there; 1: not judged");
  thresholds.minimum_brightness =
      number(table, "minimum_brightness", thresholds.minimum_brightness, "", 0.0, 1.0,
             "mean brightness, of full scale; below it the frame is black");
  thresholds.maximum_brightness =
      number(table, "maximum_brightness", thresholds.maximum_brightness, "", 0.0, 1.0,
             "mean brightness, of full scale; above it the frame is white");
  thresholds.maximum_clipped_fraction =
      number(table, "maximum_clipped_fraction", thresholds.maximum_clipped_fraction, "", 0.0, 1.0,
             "part of the pixels that may be clipped in a colour");
  read_light_and_surface(table, thresholds);
  thresholds.maximum_dead_rows =
      number(table, "maximum_dead_rows", thresholds.maximum_dead_rows, "", 0.0, 1.0,
             "part of a frame's rows that may hold one value all along where the face before "
             "has a picture; above it the frame is not complete");
  thresholds.maximum_repeated_rows =
      number(table, "maximum_repeated_rows", thresholds.maximum_repeated_rows, "", 0.0, 1.0,
             "part of a frame's rows that may be, bit for bit, an earlier frame's; above it the "
             "frame is torn or old; 1 for a camera without noise");
  thresholds.minimum_face_change =
      number(table, "minimum_face_change", thresholds.minimum_face_change, "", 0.0, 1.0,
             "part of the fine detail that must differ from the last accepted layer's, below it "
             "the grind removed nothing; 0: not judged");
  thresholds.minimum_face_change_ratio =
      number(table, "minimum_face_change_ratio", thresholds.minimum_face_change_ratio, "", 0.0, 1.0,
             "likewise, of the least that the last 16 faces changed");
  thresholds.maximum_old_part =
      number(table, "maximum_old_part", thresholds.maximum_old_part, "", 0.0, 1.0,
             "part of the frame, from an edge on, that may still show the layer before");
}

}  // namespace biotomy::acquisition
