// Numbered photographs of a made-up block: colour runs along each axis, with noise, so that no two
// voxels, colours or layers can be taken for each other. Written as PNG (third edition).
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";
import { volume } from "./voxels.mjs";

function* noise() {
  for (let state = 42; ; ) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state >>> 24;
  }
}

export function block([nz, ny, nx], bits) {
  const made = volume([3, nz, ny, nx], bits);
  const random = noise();
  const highest = bits === 8 ? 255 : 65535;
  let place = 0;
  for (let c = 0; c < 3; ++c)
    for (let z = 0; z < nz; ++z)
      for (let y = 0; y < ny; ++y)
        for (let x = 0; x < nx; ++x) {
          const run = [x / nx, y / ny, z / nz][c];
          const value = highest * (0.1 + 0.7 * run) + (random.next().value / 255) * highest * 0.15;
          // A corner of the block is black: chunks that are not stored are read too, and a shard of nothing else.
          made.data[place++] = x < nx / 3 && y < ny / 3 && z < nz / 2 ? 0 : Math.round(value);
        }
  return made;
}

function chunk(type, body) {
  const length = Buffer.alloc(4);
  length.writeUInt32BE(body.length);
  const typed = Buffer.concat([Buffer.from(type, "latin1"), body]);
  const crc = Buffer.alloc(4);
  crc.writeUInt32BE(crc32(typed));
  return Buffer.concat([length, typed, crc]);
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

function png({ shape: [, nz, ny, nx], data }, z, bits) {
  const bytes = bits / 8;
  const rows = Buffer.alloc(ny * (1 + nx * 3 * bytes)); // each begins with filter 0: none
  let place = 0;
  for (let y = 0; y < ny; ++y) {
    ++place;
    for (let x = 0; x < nx; ++x)
      for (let c = 0; c < 3; ++c) {
        const value = data[((c * nz + z) * ny + y) * nx + x];
        place = bytes === 1 ? rows.writeUInt8(value, place) : rows.writeUInt16BE(value, place);
      }
  }
  const header = Buffer.alloc(13);
  header.writeUInt32BE(nx, 0);
  header.writeUInt32BE(ny, 4);
  header[8] = bits;
  header[9] = 2; // RGB
  const signature = Buffer.from("89504e470d0a1a0a", "hex");
  return Buffer.concat([signature, chunk("IHDR", header), chunk("IDAT", zlib.deflateSync(rows, { level: 1 })),
    chunk("IEND", Buffer.alloc(0))]);
}

export function writeImages(folder, made, bits) {
  fs.mkdirSync(folder, { recursive: true });
  for (let z = 0; z < made.shape[1]; ++z) {
    fs.writeFileSync(path.join(folder, `face${String(z + 1).padStart(4, "0")}.png`), png(made, z, bits));
  }
}
