// zarr-python reads the store in a process of its own: of Debian 13 in that system's root, of this
// system when it has one.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { check, fail, pass, skip } from "./table.mjs";

// Debian's own, which has Debian's packages: another may come first in the path.
const debianPython = "/usr/bin/python3";

export function writeExpected(folder, levels) {
  fs.mkdirSync(folder, { recursive: true });
  levels.forEach(({ data }, level) => {
    fs.writeFileSync(path.join(folder, `${level}.raw`),
      Buffer.from(data.buffer, data.byteOffset, data.byteLength));
  });
}

function compare(name, program, words) {
  const { status, stdout, stderr } = spawnSync(program, words, { encoding: "utf8" });
  const lines = (stdout ?? "").trim().split("\n").filter(Boolean);
  for (const line of lines) {
    const [outcome, what, found] = line.split("\t");
    (outcome === "pass" ? pass : fail)(name, what, found);
  }
  if (status !== 0 && !lines.some((line) => line.startsWith("FAIL"))) {
    fail(name, "zarr-python", (stderr ?? "").trim().split("\n").at(-1));
  }
}

/** zarr-python changes attributes, and with them writes the metadata anew; we still read the volume. */
async function checkRewritten(name, tool, sample, root, inside) {
  await check(name, "read by us after zarr-python wrote attributes", () => {
    const rewritten = path.join(inside, "sample");
    fs.cpSync(sample, rewritten, { recursive: true });
    const script = "import zarr; group = zarr.open_group('/tmp/conformance/sample/volume.ome.zarr', mode='r+')\n" +
      "for node in (group, *(array for _, array in group.arrays())): node.attrs['seen by'] = 'zarr-python'";
    const wrote = spawnSync("chroot", [root, "python3", "-c", script], { encoding: "utf8" });
    if (wrote.status !== 0) throw new Error(wrote.stderr.trim().split("\n").at(-1));
    const metadata = JSON.parse(fs.readFileSync(path.join(rewritten, "volume.ome.zarr", "0", "zarr.json")));
    if (metadata.attributes["seen by"] !== "zarr-python") throw new Error("nothing was written");
    const pictures = [sample, rewritten].map((each, i) => {
      const picture = path.join(inside, `${i}.png`);
      const { status, stderr } = spawnSync(tool, ["section", each, "--normal", "1,2,3", "--unit", "voxel",
        "--through", "70,50,20", "-o", picture], { encoding: "utf8" });
      if (status !== 0) throw new Error(stderr);
      return fs.readFileSync(picture);
    });
    if (!pictures[0].equals(pictures[1])) throw new Error("a section differs");
  });
}

/** `root` holds a Debian 13; what is compared is copied into it and removed again. */
export async function checkZarrPython3(name, tool, sample, expected, root) {
  if (!root) {
    skip(name, "zarr-python 3", "no root of Debian 13");
    return;
  }
  const inside = path.join(root, "tmp", "conformance");
  fs.rmSync(inside, { recursive: true, force: true });
  fs.cpSync(path.join(sample, "volume.ome.zarr"), path.join(inside, "store"), { recursive: true });
  fs.cpSync(expected, path.join(inside, "expected"), { recursive: true });
  fs.copyFileSync(new URL("compare_levels.py", import.meta.url), path.join(inside, "compare_levels.py"));
  compare(name, "chroot", [root, "python3", "/tmp/conformance/compare_levels.py",
    "/tmp/conformance/store", "/tmp/conformance/expected"]);
  await checkRewritten(name, tool, sample, root, inside);
  fs.rmSync(inside, { recursive: true, force: true });
}

/** The export in OME-Zarr 0.4 (Zarr v2) by the zarr-python 2 of this system. */
export function checkExport04(name, tool, sample, expected, work) {
  const what = "zarr-python 2 on the export in OME-Zarr 0.4";
  const help = spawnSync(tool, ["export", "--help"], { encoding: "utf8" });
  if (help.status !== 0 || !help.stdout.includes("--ome-zarr")) {
    skip(name, what, "this biotomy has no command export --ome-zarr");
    return;
  }
  const version = spawnSync(debianPython, ["-c", "import zarr; print(zarr.__version__)"], { encoding: "utf8" });
  if (!version.stdout?.startsWith("2.")) {
    skip(name, what, "this system has no zarr-python 2 (Debian 12: python3-zarr)");
    return;
  }
  const store = path.join(work, "export-0.4.ome.zarr");
  const made = spawnSync(tool, ["export", sample, "--ome-zarr", "0.4", "-o", store], { encoding: "utf8" });
  if (made.status !== 0) {
    fail(name, "biotomy export --ome-zarr 0.4", made.stderr.trim());
    return;
  }
  compare(name, debianPython, [new URL("compare_levels.py", import.meta.url).pathname, store, expected]);
}
