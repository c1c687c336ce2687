// Pictures as rows of bytes R, G, B, A.
import assert from "node:assert/strict";
import { PNG } from "pngjs";

/** {width, height, data} of a PNG file's bytes. */
export const decoded = (bytes) => PNG.sync.read(bytes);

/** What a canvas of the page holds, pixel by pixel. */
export async function pixelsOf(canvas) {
  const { width, height, base64 } = await canvas.evaluate((element) => {
    const { data } = element.getContext("2d").getImageData(0, 0, element.width, element.height);
    let text = "";
    const piece = 0x8000; // as many arguments as any browser takes
    for (let i = 0; i < data.length; i += piece) {
      text += String.fromCharCode(...data.subarray(i, i + piece));
    }
    return { width: element.width, height: element.height, base64: btoa(text) };
  });
  return { width, height, data: Buffer.from(base64, "base64") };
}

/** Fails unless both are the same to the last bit. */
export function assertSame(actual, expected, where) {
  const size = ({ width, height }) => `${width} × ${height}`;
  assert.equal(size(actual), size(expected), where);
  let different = 0;
  let worst = 0;
  for (let i = 0; i < expected.data.length; ++i) {
    const by = Math.abs(actual.data[i] - expected.data[i]);
    if (by > 0) ++different;
    worst = Math.max(worst, by);
  }
  assert.equal(different, 0, `${where}: ${different} bytes differ, by up to ${worst}`);
}

/** How many colours there are in it: a picture of nothing has one. */
export function colours({ data }) {
  const seen = new Set();
  for (let i = 0; i < data.length; i += 4) seen.add(data.readUIntBE(i, 3));
  return seen.size;
}
