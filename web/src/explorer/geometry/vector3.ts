/** x, y, z of the sample frame: x right, y down, z into the block. Positions are micrometres. */
export type Vector3 = readonly [number, number, number];

export const add = (a: Vector3, b: Vector3): Vector3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vector3, b: Vector3): Vector3 => [
  a[0] - b[0],
  a[1] - b[1],
  a[2] - b[2],
];
export const scale = (k: number, a: Vector3): Vector3 => [k * a[0], k * a[1], k * a[2]];
export const dot = (a: Vector3, b: Vector3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector3, b: Vector3): Vector3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const norm = (a: Vector3): number => Math.hypot(a[0], a[1], a[2]);

/** a + k·direction */
export const along = (a: Vector3, k: number, direction: Vector3): Vector3 =>
  add(a, scale(k, direction));

export const centroid = (points: readonly Vector3[]): Vector3 =>
  scale(1 / points.length, points.reduce(add, [0, 0, 0]));

/** Below zero when a comes before b by x, then y, then z. */
export const inOrder = (a: Vector3, b: Vector3): number =>
  a[0] - b[0] || a[1] - b[1] || a[2] - b[2];

/** Cosine and sine of an angle in degrees; those of right angles are exact. */
export function direction(degrees: number): [number, number] {
  const radians = (degrees * Math.PI) / 180;
  const pair: [number, number] = [Math.cos(radians), Math.sin(radians)];
  return degrees % 90 === 0 ? [Math.round(pair[0]) + 0, Math.round(pair[1]) + 0] : pair;
}

/** Turned about `axis`, of length 1, by an angle in degrees, right-handed (Rodrigues' formula). */
export function turned(v: Vector3, axis: Vector3, degrees: number): Vector3 {
  const [cosine, sine] = direction(degrees);
  return add(
    add(scale(cosine, v), scale(sine, cross(axis, v))),
    scale((1 - cosine) * dot(axis, v), axis),
  );
}
