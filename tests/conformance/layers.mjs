// The layer files of a sample, read by these lines alone: tiled little-endian TIFF, deflate,
// horizontal predictor (TIFF 6.0, sections 14 and 15; Adobe's deflate, compression 8).
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";
import { volume } from "./voxels.mjs";

const sizes = { 1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 16: 8 };

function directory(file) {
  if (file.toString("latin1", 0, 2) !== "II" || file.readUInt16LE(2) !== 42) {
    throw new Error("is no little-endian TIFF");
  }
  const tags = new Map();
  const start = file.readUInt32LE(4);
  for (let i = 0; i < file.readUInt16LE(start); ++i) {
    const entry = start + 2 + 12 * i;
    const type = file.readUInt16LE(entry + 2);
    const count = file.readUInt32LE(entry + 4);
    const place = count * sizes[type] <= 4 ? entry + 8 : file.readUInt32LE(entry + 8);
    const read = { 3: (at) => file.readUInt16LE(at), 4: (at) => file.readUInt32LE(at),
      16: (at) => Number(file.readBigUInt64LE(at)) }[type];
    if (read) {
      tags.set(file.readUInt16LE(entry),
        Array.from({ length: count }, (_, n) => read(place + n * sizes[type])));
    }
  }
  return tags;
}

function readLayer(name, into, z) {
  const file = fs.readFileSync(name);
  const tags = directory(file);
  const one = (tag) => tags.get(tag)?.[0];
  const [, nz, ny, nx] = into.shape;
  const bytes = into.data.BYTES_PER_ELEMENT;
  const wanted = { 256: nx, 257: ny, 258: 8 * bytes, 259: 8, 262: 2, 277: 3, 284: 1, 317: 2 };
  for (const [tag, value] of Object.entries(wanted)) {
    if (one(Number(tag)) !== value) throw new Error(`${name}: tag ${tag} is ${one(Number(tag))}`);
  }
  const [width, height] = [one(322), one(323)];
  const across = Math.ceil(nx / width);
  tags.get(324).forEach((offset, tile) => {
    const plain = zlib.inflateSync(file.subarray(offset, offset + tags.get(325)[tile]));
    const values = bytes === 1 ? plain
      : new Uint16Array(plain.buffer.slice(plain.byteOffset, plain.byteOffset + plain.length));
    const left = (tile % across) * width;
    const top = Math.floor(tile / across) * height;
    for (let row = 0; row < height && top + row < ny; ++row) {
      const sums = [0, 0, 0];
      for (let column = 0; column < width && left + column < nx; ++column)
        for (let c = 0; c < 3; ++c) {
          sums[c] += values[(row * width + column) * 3 + c];
          // Stored modulo 2^8 or 2^16, which the typed array's own cut restores.
          into.data[((c * nz + z) * ny + top + row) * nx + left + column] = sums[c];
        }
    }
  });
}

export function readLayers(sample, shape, bits) {
  const whole = volume(shape, bits);
  for (let z = 0; z < shape[1]; ++z) {
    readLayer(path.join(sample, "layers", `${String(z + 1).padStart(6, "0")}.tif`), whole, z);
  }
  return whole;
}
