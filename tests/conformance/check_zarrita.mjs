import path from "node:path";
import { FileSystemStore } from "@zarrita/storage";
import * as zarr from "zarrita";
import { check } from "./table.mjs";
import { difference, region } from "./voxels.mjs";

/** In C order: what zarrita returns of transposed chunks lies in memory as they do. */
function inOrder({ shape, stride, data }) {
  const ordered = { shape, data: new data.constructor(data.length) };
  let place = 0;
  for (let c = 0; c < shape[0]; ++c)
    for (let z = 0; z < shape[1]; ++z)
      for (let y = 0; y < shape[2]; ++y)
        for (let x = 0; x < shape[3]; ++x) {
          ordered.data[place++] = data[c * stride[0] + z * stride[1] + y * stride[2] + x * stride[3]];
        }
  return ordered;
}

export async function checkZarrita(name, store, levels) {
  const group = await zarr.open(new FileSystemStore(path.resolve(store)), { kind: "group" });
  const open = (level) => zarr.open(group.resolve(String(level)), { kind: "array" });
  for (const [level, expected] of levels.entries()) {
    await check(name, `zarrita: level ${level}, whole`, async () => {
      const array = await open(level);
      if (String(array.dimensionNames ?? "c,z,y,x") !== "c,z,y,x") throw new Error(array.dimensionNames);
      const wrong = difference(inOrder(await zarr.get(array)), expected);
      if (wrong) throw new Error(wrong);
      return expected.shape.join("×");
    });
  }
  await check(name, "zarrita: level 0, a region", async () => {
    const [, ...size] = levels[0].shape;
    const from = size.map((n) => Math.floor(n / 3));
    const to = size.map((n) => n - 1);
    const found = await zarr.get(await open(0), [null, ...from.map((first, i) => zarr.slice(first, to[i]))]);
    const wrong = difference(inOrder(found), region(levels[0], from, to));
    if (wrong) throw new Error(wrong);
    return from.map((first, i) => `${first}:${to[i]}`).join(", ");
  });
}
