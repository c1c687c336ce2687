// Bundles neuroglancer as its own page, with the one data source that it needs here.
import fs from "node:fs";
import path from "node:path";
import { build } from "esbuild";

const lib = path.dirname(new URL(import.meta.resolve("neuroglancer")).pathname);

const conditions = [
  "neuroglancer/datasource:none_by_default", "neuroglancer/datasource/zarr:enabled",
  "neuroglancer/kvstore:none_by_default", "neuroglancer/kvstore/http:enabled",
  "neuroglancer/layer:none_by_default", "neuroglancer/layer/image:enabled",
];

const pictures = {
  name: "icons that are in no registry, and pictures as text",
  setup(bundle) {
    bundle.onResolve({ filter: /^ikonate\// }, ({ path: name }) => ({ path: name, namespace: "icon" }));
    bundle.onLoad({ filter: /.*/, namespace: "icon" }, () => ({ contents: "<svg/>", loader: "text" }));
    bundle.onResolve({ filter: /\?raw$/ }, async ({ path: name, resolveDir, importer }) => {
      const plain = await bundle.resolve(name.replace(/\?raw$/, ""), { resolveDir, importer, kind: "import-statement" });
      return { path: plain.path, namespace: "text" };
    });
    bundle.onLoad({ filter: /.*/, namespace: "text" }, ({ path: name }) =>
      ({ contents: fs.readFileSync(name, "utf8"), loader: "text" }));
  },
};

/** Below `folder`: page/index.html and what it loads. Kept while neuroglancer's version is the same. */
export async function makePage(folder) {
  const { version } = JSON.parse(fs.readFileSync(path.join(lib, "..", "package.json")));
  const mark = path.join(folder, "made-of");
  if (fs.existsSync(mark) && fs.readFileSync(mark, "utf8") === version) return version;
  fs.rmSync(folder, { recursive: true, force: true });
  const entry = (name) => path.join(lib, `${name}.bundle.js`);
  const shared = { bundle: true, format: "esm", minify: true, conditions, plugins: [pictures],
    logLevel: "error", loader: { ".wasm": "file", ".svg": "text", ".html": "text" } };
  await build({ ...shared, entryPoints: [entry("main"), entry("chunk_worker")], outdir: path.join(folder, "page") });
  await build({ ...shared, entryPoints: [entry("async_computation")], outdir: folder });
  fs.copyFileSync(path.join(folder, "async_computation.bundle.js"), path.join(folder, "page", "async_computation.bundle.js"));
  fs.writeFileSync(path.join(folder, "page", "index.html"),
    `<!doctype html><meta charset="utf-8"><title>neuroglancer</title>
<style>html, body { margin: 0; height: 100%; } #neuroglancer-container { position: absolute; inset: 0; }</style>
<link rel="stylesheet" href="main.bundle.css"><div id="neuroglancer-container"></div>
<script type="module" src="main.bundle.js"></script>`);
  fs.writeFileSync(mark, version);
  return version;
}
