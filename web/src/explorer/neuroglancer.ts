import type { Sample } from "../api/types";
import { cross, norm } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import { sectionBasis } from "./geometry/section_basis";
import type { PlacedPlane } from "./plane_state";

/** The three channels of a voxel as its colour. */
const shader =
  "void main() {\n" +
  "  emitRGB(vec3(toNormalized(getDataValue(0)), toNormalized(getDataValue(1)), " +
  "toNormalized(getDataValue(2))));\n}\n";

/** A rotation (x, y, z, w) that takes the screen's right, down and away to these directions. */
export function quaternionOf(right: Vector3, down: Vector3, away: Vector3): number[] {
  const [[a, d, g], [b, e, h], [c, f, i]] = [right, down, away];
  // Shepperd 1978: the largest of the four is computed first, so that nothing cancels.
  const squares = [1 + a - e - i, 1 - a + e - i, 1 - a - e + i, 1 + a + e + i];
  const largest = squares.indexOf(Math.max(...squares));
  const s = 2 * Math.sqrt(squares[largest]);
  const rows = [
    [s / 4, (b + d) / s, (c + g) / s, (h - f) / s],
    [(b + d) / s, s / 4, (f + h) / s, (c - g) / s],
    [(c + g) / s, (f + h) / s, s / 4, (d - b) / s],
    [(h - f) / s, (c - g) / s, (d - b) / s, s / 4],
  ];
  return rows[largest];
}

/** A link that opens the volume in neuroglancer, cut as it is here. */
export function neuroglancerLink(
  base: string,
  origin: string,
  sample: Sample,
  placed: PlacedPlane | null,
): string {
  const [dx, dy, dz] = sample.spacing_um;
  const middle = placed?.through ?? [0, 0, 0];
  const { p, q } = placed
    ? sectionBasis("layer", placed.plane)
    : { p: [1, 0, 0] as const, q: [0, 1, 0] as const };
  const away = cross(p, q);
  const [x, y, z] = sample.spacing_um.map((um) => [um / 1e6, "m"]);
  const state = {
    dimensions: { x, y, z },
    position: [middle[0] / dx, middle[1] / dy, middle[2] / dz],
    crossSectionOrientation: quaternionOf(p, q, away),
    crossSectionScale: norm([...sample.size]) / 600,
    layers: [
      {
        type: "image",
        name: sample.name,
        source: {
          url: `zarr3://${origin}${sample.volume_url}`,
          // The mark makes the colours one voxel's channels, in place of a dimension to walk along.
          transform: { outputDimensions: { "c^": [1, ""], z, y, x } },
        },
        shader,
      },
    ],
    selectedLayer: { layer: sample.name },
    layout: "4panel",
  };
  return `${base.replace(/\/$/, "")}/#!${encodeURIComponent(JSON.stringify(state))}`;
}
