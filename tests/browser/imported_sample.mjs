// A sample of made-up images, shown by `biotomy view` without a rig.
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { PNG } from "pngjs";
import { Program, biotomy } from "./programs.mjs";

const mostDifferent = 64; // images; after them they come again

/** A layer of colours that differ at every voxel. */
function layerImage({ x: width, y: height }, z) {
  const image = new PNG({ width, height });
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      image.data.set([x * 2, y * 2, (z * 12 + x * y) % 256, 255], (y * width + x) * 4);
    }
  }
  return PNG.sync.write(image);
}

export class ImportedSample {
  #folder;
  #view;

  /** `size`: {x, y, z} in voxels; `name`: of the sample's folder. */
  static async show(size, name) {
    const shown = new ImportedSample();
    shown.#folder = fs.mkdtempSync(path.join(os.tmpdir(), "biotomy-browser-"));
    try {
      await shown.#start(size, name);
    } catch (error) {
      await shown.stop();
      throw error;
    }
    return shown;
  }

  async #start(size, name) {
    const images = path.join(this.#folder, "images");
    const file = (z) => path.join(images, `${String(z).padStart(5, "0")}.png`);
    fs.mkdirSync(images);
    for (let z = 0; z < size.z; ++z) {
      if (z < mostDifferent) fs.writeFileSync(file(z), layerImage(size, z));
      else fs.linkSync(file(z % mostDifferent), file(z));
    }
    const sample = path.join(this.#folder, name);
    const made = biotomy("import", images, "--spacing", "10,10,20", "-o", sample);
    assert.equal(made.status, 0, made.stderr);
    const words = ["view", sample, "--listen", "127.0.0.1:0", "--no-browser"];
    this.#view = new Program("biotomy", words, this.#folder);
    this.url = `http://${(await this.#view.says("http://")).replace(/[/\s].*$/, "")}`;
  }

  /** Sends `signal`: the program's exit code, or the signal that ended it. */
  end(signal) {
    return this.#view.end(signal);
  }

  async stop() {
    await this.#view?.end("SIGKILL");
    fs.rmSync(this.#folder, { recursive: true, force: true });
  }
}
