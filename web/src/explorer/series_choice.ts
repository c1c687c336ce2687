import { corners } from "./geometry/cuboid";
import type { Cuboid } from "./geometry/cuboid";
import { range } from "./geometry/plane";
import type { Plane } from "./geometry/plane";
import { boundingRectangle } from "./geometry/plane_rectangle";
import { sectionBasis } from "./geometry/section_basis";
import type { Basis, BasisKind } from "./geometry/section_basis";
import { sectionPolygon } from "./geometry/section_polygon";
import { norm, scale, turned } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import { stepAlong } from "./plane_state";
import type { PlacedPlane } from "./plane_state";
import type { Query } from "./section_query";
import { readablePixel } from "./section_window";

/** Planes one after the other, begun from the plane that is shown. */
export interface SeriesChoice {
  kind: "rotate" | "translate";
  axis: "x" | "y" | "z" | "own";
  ownAxis: Vector3;
  turn: { from: number; to: number; step: number }; // degrees
  way: { step: number | null }; // micrometres; none: some sixty frames through the whole block
}

export const defaultSeries: SeriesChoice = {
  kind: "rotate",
  axis: "x",
  ownAxis: [1, 1, 0],
  turn: { from: 0, to: 180, step: 3 },
  way: { step: null },
};

const usualFrames = 60;

/** Whole steps from voxel to voxel, so many that the series has about sixty frames. */
export function wayStep({ way }: SeriesChoice, { plane }: PlacedPlane, cuboid: Cuboid): number {
  if (way.step !== null) return way.step;
  const [least, most] = range(corners(cuboid), plane.normal);
  const step = stepAlong(plane.normal, cuboid);
  return readablePixel(step * Math.max(1, Math.ceil((most - least) / step / usualFrames)));
}

const axisOf = ({ axis, ownAxis }: SeriesChoice): Vector3 =>
  axis === "own" ? ownAxis : ([0, 1, 2].map((i) => ("xyz"[i] === axis ? 1 : 0)) as never);

/** As `biotomy series` takes it. */
export function seriesQuery(choice: SeriesChoice, placed: PlacedPlane, cuboid: Cuboid): Query {
  const normal = placed.plane.normal.join(",");
  if (choice.kind === "translate") {
    return { kind: "translate", normal, step: String(wayStep(choice, placed, cuboid)) };
  }
  const { from, to, step } = choice.turn;
  return {
    kind: "rotate",
    axis: choice.axis === "own" ? choice.ownAxis.join(",") : choice.axis,
    through: placed.through.join(","),
    normal,
    from: String(from),
    to: String(to),
    step: String(step),
  };
}

/** A frame as the server names it. */
export interface SeriesFrame {
  index: number;
  value: number; // degrees or micrometres
  label: string;
  cuts: boolean; // else the plane misses the block
  plane: { normal: Vector3; offset_um: number };
}

export const planeOf = ({ plane }: SeriesFrame): Plane => ({
  normal: plane.normal,
  offset: plane.offset_um,
});

/** The bases turn with the planes from the first one's, so that no picture flips. */
export function frameBasis(
  choice: SeriesChoice,
  kind: BasisKind,
  first: SeriesFrame,
  frame: SeriesFrame,
): Basis {
  const basis = sectionBasis(kind, planeOf(first));
  if (choice.kind === "translate") return basis;
  const axis = axisOf(choice);
  const unit = scale(1 / norm(axis), axis);
  const angle = frame.value - first.value;
  return { p: turned(basis.p, unit, angle), q: turned(basis.q, unit, angle) };
}

/** The pixel with which the largest frame just fits: the same for all, so that nothing jumps. */
export function framePixel(
  choice: SeriesChoice,
  kind: BasisKind,
  frames: readonly SeriesFrame[],
  cuboid: Cuboid,
  width: number,
  height: number,
): number {
  const pixels = frames.map((frame) => {
    const polygon = sectionPolygon(planeOf(frame), cuboid);
    if (polygon.length < 3) return 0;
    const rectangle = boundingRectangle(polygon, frameBasis(choice, kind, frames[0], frame));
    return Math.max(
      rectangle.width / Math.max(1, width - 1),
      rectangle.height / Math.max(1, height - 1),
    );
  });
  const largest = Math.max(...pixels);
  return largest > 0 ? readablePixel(largest * 1.0002) : 1;
}
