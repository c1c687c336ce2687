// zarr-python reads the store in a process of its own: of Debian 13 in that system's root, of this
// system when it has one.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { fail, pass, skip } from "./table.mjs";

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

/** `root` holds a Debian 13; what is compared is copied into it and removed again. */
export function checkZarrPython3(name, store, expected, root) {
  if (!root) {
    skip(name, "zarr-python 3", "no root of Debian 13");
    return;
  }
  const inside = path.join(root, "tmp", "conformance");
  fs.rmSync(inside, { recursive: true, force: true });
  fs.cpSync(store, path.join(inside, "store"), { recursive: true });
  fs.cpSync(expected, path.join(inside, "expected"), { recursive: true });
  fs.copyFileSync(new URL("compare_levels.py", import.meta.url), path.join(inside, "compare_levels.py"));
  compare(name, "chroot", [root, "python3", "/tmp/conformance/compare_levels.py",
    "/tmp/conformance/store", "/tmp/conformance/expected"]);
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
  const version = spawnSync("python3", ["-c", "import zarr; print(zarr.__version__)"], { encoding: "utf8" });
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
  compare(name, "python3", [new URL("compare_levels.py", import.meta.url).pathname, store, expected]);
}
