// Makes samples by `biotomy import` and lets other people's programs read them.
// usage: node run.mjs TOOL WORK CACHE SCHEMAS [ROOT]
//   WORK: an empty folder for the samples; CACHE: for what is made once; ROOT: of a Debian 13
import { spawnSync } from "node:child_process";
import path from "node:path";
import { checkMetadata } from "./check_metadata.mjs";
import { checkNeuroglancer } from "./check_neuroglancer.mjs";
import { checkExport04, checkZarrPython3, writeExpected } from "./check_zarr_python.mjs";
import { checkZarrita } from "./check_zarrita.mjs";
import { block, writeImages } from "./images.mjs";
import { readLayers } from "./layers.mjs";
import { factors, levels } from "./pyramid.mjs";
import { check, close, fail } from "./table.mjs";
import { difference } from "./voxels.mjs";

const [tool, work, cache, schemas, root] = process.argv.slice(2);

const size = [37, 110, 150]; // z, y, x: no multiple of anything
const spacing = [40, 11, 10];
const chunk = [16, 16, 16];
const volumes = [
  { bits: 8, colours: "interleaved", codec: "blosc-lz4-noshuffle" },
  { bits: 8, colours: "planar", codec: "blosc-zstd1-shuffle" },
  { bits: 16, colours: "interleaved", codec: "zstd1" },
  { bits: 16, colours: "planar", codec: "blosc-lz4-bitshuffle" },
];

for (const { bits, colours, codec } of volumes) {
  const name = `${bits} bits, ${colours}`;
  const folder = path.join(work, `${bits}-${colours}`);
  const sample = path.join(folder, "sample");
  const made = block(size, bits);
  writeImages(path.join(folder, "images"), made, bits);
  const { status, stderr } = spawnSync(tool, ["import", path.join(folder, "images"),
    "--spacing", spacing.toReversed().join(","), "--chunk", chunk.toReversed().join(","),
    "--shard", "32,32,16", "--codec", codec, "--colours", colours,
    "--layer-compression", "deflate", "-o", sample], { encoding: "utf8" });
  if (status !== 0) {
    fail(name, "biotomy import", stderr.trim());
    continue;
  }
  const layers = readLayers(sample, made.shape, bits);
  await check(name, "layers are the images", () => {
    const wrong = difference(layers, made);
    if (wrong) throw new Error(wrong);
    return codec;
  });
  const steps = factors(size, spacing, chunk);
  const expected = levels(layers, steps);
  const store = path.join(sample, "volume.ome.zarr");
  await checkMetadata(name, store, steps, spacing, schemas);
  await checkZarrita(name, store, expected);
  writeExpected(path.join(folder, "expected"), expected);
  await checkZarrPython3(name, tool, sample, path.join(folder, "expected"), root);
  checkExport04(name, tool, sample, path.join(folder, "expected"), folder);
  await checkNeuroglancer(name, store, layers, spacing, work, path.join(cache, "neuroglancer"));
}
process.exit(close() ? 0 : 1);
