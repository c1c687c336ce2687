import type { PlaneRectangle } from "./geometry/plane_rectangle";
import type { Vector3 } from "./geometry/vector3";

/** What the server says of a picture of a section: reconstruct/section/section_record.hpp. */
export interface SectionRecord {
  plane: { normal: Vector3; offset_um: number };
  polygon_um: Vector3[];
  rectangle: { origin_um: Vector3; p: Vector3; q: Vector3; width_um: number; height_um: number };
  pixel_um: number;
  picture: { width: number; height: number };
  pixel_to_sample: [Vector3, Vector3, Vector3]; // · (u, v, 1) = (x, y, z)
  full: { pixel_um: number; width: number; height: number }; // were it not made to fit
  command: string; // makes the picture at full resolution
  command_here: string; // at this resolution
  layers_present: number;
  generation: number;
}

export const rectangleOf = ({ rectangle }: SectionRecord): PlaneRectangle => ({
  origin: rectangle.origin_um,
  p: rectangle.p,
  q: rectangle.q,
  width: rectangle.width_um,
  height: rectangle.height_um,
});

/** Where a place in the picture lies in the sample. Whole u and v are the centres of pixels. */
export const sampleAt = ({ pixel_to_sample }: SectionRecord, u: number, v: number): Vector3 =>
  pixel_to_sample.map(([right, down, first]) => right * u + down * v + first) as unknown as Vector3;

/** A picture of a section with what is known of it. */
export interface SectionPicture {
  image: ImageBitmap;
  record: SectionRecord;
  sharp: boolean; // at the screen's resolution and without loss; else quickly made
  whole: boolean; // else the part that is seen in a close-up
}
