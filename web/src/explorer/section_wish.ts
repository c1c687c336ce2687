import { leastSpacing } from "./geometry/cuboid";
import type { Cuboid } from "./geometry/cuboid";
import type { PlaneRectangle } from "./geometry/plane_rectangle";
import { sectionBasis } from "./geometry/section_basis";
import type { PlacedPlane } from "./plane_state";
import type { SectionChoices } from "./section_choices";
import { sectionAddress } from "./section_fetch";
import type { PictureRequest, Wish } from "./section_loader";
import { choicesQuery, planeQuery } from "./section_query";
import type { Query } from "./section_query";
import { closeupWindow, readablePixel, visiblePart } from "./section_window";
import type { Closeup } from "./view_hash";

/** What is to be seen of a section, and where. */
export interface SectionLook {
  placed: PlacedPlane;
  cuboid: Cuboid;
  choices: SectionChoices; // the rectangle is that which is shown
  of: string; // names the section in PictureRequest
  seen: PlaneRectangle | null; // of which a close-up shows a part; none: not known yet
  closeup: Closeup | null;
  width: number; // of the panel, pixels of the screen
  height: number;
  generation: number; // of the sample
}

const previewSide = 640;
/** A preview has so many fewer pixels along a side, in a close-up. */
const previewCoarseness = 2.5;
const preview = { format: "jpeg", quality: "85" };

/** None while there is no panel, or nothing of the section in it. */
export function wishFor(look: SectionLook): Wish | null {
  const { width, height, of, closeup, seen } = look;
  if (width === 0 || height === 0) return null;
  const whole = closeup === null || seen === null;
  const request = (query: Query, sharp: boolean): PictureRequest => ({
    address: sectionAddress({
      ...query,
      ...(sharp ? { format: "png" } : preview),
      generation: String(look.generation),
    }),
    of,
    sharp,
    whole,
  });
  if (whole) {
    const smaller = Math.min(1, previewSide / Math.max(width, height));
    const fit = `${Math.ceil(width * smaller)}x${Math.ceil(height * smaller)}`;
    const query = { ...planeQuery(look.placed.definition), ...choicesQuery(look.choices) };
    return {
      preview: request({ ...query, fit }, false),
      sharp: request({ ...query, fit: `${width}x${height}` }, true),
    };
  }
  const quick = partQuery(look, seen, closeup, readablePixel(closeup.pixel * previewCoarseness));
  const sharp = partQuery(look, seen, closeup, closeup.pixel);
  return quick && sharp && { preview: request(quick, false), sharp: request(sharp, true) };
}

/** The part that a close-up shows, with pixels no finer than voxels. */
function partQuery(
  { placed, cuboid, choices, width, height }: SectionLook,
  seen: PlaneRectangle,
  closeup: Closeup,
  pixel: number,
): Query | null {
  const least = leastSpacing(cuboid);
  const basis = sectionBasis(choices.basis, placed.plane);
  const window = closeupWindow(seen, width, height, closeup);
  const theta = visiblePart(window, Math.max(pixel, least), basis);
  if (!theta) return null;
  return {
    ...planeQuery(placed.definition),
    ...choicesQuery({ ...choices, theta }),
    ...(pixel > least ? { pixel: String(pixel) } : {}),
  };
}
