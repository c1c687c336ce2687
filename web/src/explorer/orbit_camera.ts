import { along, direction, dot, subtract } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";

/**
 * From where the block is looked at. The projection is parallel, so that equal lengths look equal
 * and a section on the screen is an affine picture of itself. At azimuth 0 and elevation 90 the
 * front face is seen as the camera sees it: x right, y down, z away.
 */
export interface OrbitCamera {
  azimuth: number; // degrees about z
  elevation: number; // degrees above the front face's edge: −90 from below to 90 from above
  zoom: number; // 1: the block fits the window
}

export const startingCamera: OrbitCamera = { azimuth: 28, elevation: 32, zoom: 1 };

const leastZoom = 0.4;
const mostZoom = 20;

/** Directions of the screen, of length 1, in the sample frame. */
export interface ScreenAxes {
  right: Vector3;
  up: Vector3;
  towards: Vector3; // the viewer
}

export function screenAxes({ azimuth, elevation }: OrbitCamera): ScreenAxes {
  const [cosine, sine] = direction(azimuth);
  const [level, above] = direction(elevation);
  return {
    right: [cosine, sine, 0],
    up: [above * sine, -above * cosine, -level],
    towards: [-level * sine, level * cosine, -above],
  };
}

export const orbited = (camera: OrbitCamera, azimuth: number, elevation: number): OrbitCamera => ({
  ...camera,
  azimuth: ((((camera.azimuth + azimuth + 180) % 360) + 360) % 360) - 180,
  elevation: Math.min(90, Math.max(-90, camera.elevation + elevation)),
});

export const zoomed = (camera: OrbitCamera, factor: number): OrbitCamera => ({
  ...camera,
  zoom: Math.min(mostZoom, Math.max(leastZoom, camera.zoom * factor)),
});

/** Places on the screen of places in the sample: CSS pixels from the window's upper left corner. */
export interface Projection {
  axes: ScreenAxes;
  middle: Vector3; // of the sample, shown in the middle of the window
  scale: number; // pixels per micrometre
  width: number;
  height: number;
}

const roomAround = 0.76; // the part of the window that the block takes, labels beside it

/** The block's size on the screen does not depend on the angle, so that it does not pump. */
export function projectionOf(
  camera: OrbitCamera,
  far: Vector3,
  width: number,
  height: number,
): Projection {
  const axes = screenAxes(camera);
  const middle: Vector3 = [far[0] / 2, far[1] / 2, far[2] / 2];
  const diagonal = Math.hypot(...far) || 1;
  const scale = (camera.zoom * roomAround * Math.min(width, height * 1.25)) / diagonal;
  return { axes, middle, scale, width, height };
}

export function projected(projection: Projection, point: Vector3): [number, number] {
  const { axes, middle, scale, width, height } = projection;
  const from = subtract(point, middle);
  return [width / 2 + scale * dot(from, axes.right), height / 2 - scale * dot(from, axes.up)];
}

/** The point of the plane across the screen through the block's middle that a pixel shows. */
export function unprojected(projection: Projection, [x, y]: readonly [number, number]): Vector3 {
  const { axes, middle, scale, width, height } = projection;
  return along(
    along(middle, (x - width / 2) / scale, axes.right),
    (height / 2 - y) / scale,
    axes.up,
  );
}
