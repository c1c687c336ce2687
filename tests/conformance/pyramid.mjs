// What the levels of a volume must be, computed from level 0 by the rule and not by our writer:
// each level halves the axes whose voxels are finest, up to √2 times the least, among those with
// more than one voxel, until a level fits into one chunk; each voxel is the mean of the two voxels
// along each halved axis that exist in the level before, rounded to nearest, half up.
import { at, volume } from "./voxels.mjs";

/** Factors along z, y, x of every level. */
export function factors(size, spacing, chunk) {
  const levels = [[1, 1, 1]];
  for (;;) {
    const factor = levels.at(-1);
    const now = size.map((n, axis) => Math.ceil(n / factor[axis]));
    if (now.every((n, axis) => n <= chunk[axis])) return levels;
    const voxel = spacing.map((um, axis) => um * factor[axis]);
    const finest = Math.min(...voxel.filter((_, axis) => now[axis] > 1));
    levels.push(factor.map((f, axis) =>
      now[axis] > 1 && voxel[axis] <= Math.SQRT2 * finest ? 2 * f : f));
  }
}

export function halved(fine, step) {
  const [, ...before] = fine.shape;
  const size = before.map((n, axis) => Math.ceil(n / step[axis]));
  const coarse = volume([3, ...size], 8 * fine.data.BYTES_PER_ELEMENT);
  const existing = (i, axis) => {
    const first = i * step[axis];
    return step[axis] === 2 && first + 1 < before[axis] ? [first, first + 1] : [first];
  };
  let place = 0;
  for (let c = 0; c < 3; ++c)
    for (let z = 0; z < size[0]; ++z)
      for (let y = 0; y < size[1]; ++y)
        for (let x = 0; x < size[2]; ++x) {
          let sum = 0;
          let count = 0;
          for (const k of existing(z, 0))
            for (const j of existing(y, 1))
              for (const i of existing(x, 2)) {
                sum += at(fine, c, k, j, i);
                ++count;
              }
          coarse.data[place++] = Math.floor((2 * sum + count) / (2 * count));
        }
  return coarse;
}

export function levels(finest, steps) {
  const all = [finest];
  for (let level = 1; level < steps.length; ++level) {
    all.push(halved(all[level - 1], steps[level].map((f, axis) => f / steps[level - 1][axis])));
  }
  return all;
}
