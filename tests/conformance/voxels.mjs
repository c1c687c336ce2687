// Whole volumes in memory: { shape: [3, z, y, x], data: Uint8Array or Uint16Array }, in C order.

export const typeOf = (bits) => (bits === 8 ? Uint8Array : Uint16Array);

export function volume(shape, bits) {
  return { shape, data: new (typeOf(bits))(shape.reduce((a, b) => a * b)) };
}

export const at = ({ shape: [, nz, ny, nx], data }, c, z, y, x) =>
  data[((c * nz + z) * ny + y) * nx + x];

/** Where two volumes differ first, or nothing. */
export function difference(found, expected) {
  if (String(found.shape) !== String(expected.shape)) {
    return `shape ${found.shape}, expected ${expected.shape}`;
  }
  if (found.data.constructor !== expected.data.constructor) {
    return `${found.data.constructor.name}, expected ${expected.data.constructor.name}`;
  }
  const place = expected.data.findIndex((value, i) => found.data[i] !== value);
  return place < 0
    ? undefined
    : `value ${place} is ${found.data[place]}, expected ${expected.data[place]}`;
}

/** The part [z, y, x from, to) of a volume, all colours. */
export function region(whole, from, to) {
  const size = to.map((end, axis) => end - from[axis]);
  const part = { shape: [3, ...size], data: new whole.data.constructor(3 * size[0] * size[1] * size[2]) };
  let place = 0;
  for (let c = 0; c < 3; ++c)
    for (let z = from[0]; z < to[0]; ++z)
      for (let y = from[1]; y < to[1]; ++y)
        for (let x = from[2]; x < to[2]; ++x) part.data[place++] = at(whole, c, z, y, x);
  return part;
}
