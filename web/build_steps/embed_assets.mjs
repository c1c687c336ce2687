// Writes the page that Vite built as a C++ source that defines page_assets().
// usage: node embed_assets.mjs DIST OUTPUT.cpp
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { extname, join } from "node:path";

import { gzip } from "./gzip.mjs";

const contentTypes = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".svg": "image/svg+xml",
  ".png": "image/png",
};

/** The files of the page: index.html, and what is in assets/, in the order of their names. */
function assetsOf(dist) {
  const names = readdirSync(join(dist, "assets")).sort();
  return ["index.html", ...names.map((name) => `assets/${name}`)].map((name) => {
    const type = contentTypes[extname(name)];
    if (!type) throw new Error(`${name}: its content type is not in the list`);
    return { path: `/${name}`, type, content: gzip(readFileSync(join(dist, name))) };
  });
}

/** A string literal in pieces; bytes that are not plain letters as octal numbers of three digits. */
function literal(bytes) {
  const lines = [];
  let line = "";
  for (const byte of bytes) {
    const isPlain = byte >= 0x20 && byte < 0x7f && !'"\\?'.includes(String.fromCharCode(byte));
    line += isPlain ? String.fromCharCode(byte) : `\\${byte.toString(8).padStart(3, "0")}`;
    if (line.length > 96) {
      lines.push(`    "${line}"`);
      line = "";
    }
  }
  lines.push(`    "${line}"`);
  return lines.join("\n");
}

function sourceOf(assets) {
  const entries = assets.map(({ path, type, content }) => {
    const view = `std::string_view(\n${literal(content)},\n    ${content.length})`;
    return `    {${JSON.stringify(path)}, ${JSON.stringify(type)}, ${view}},`;
  });
  return `// Made by web/build_steps/embed_assets.mjs.
#include "acquisition/http/page_asset.hpp"

namespace biotomy::acquisition {
namespace {

constexpr PageAsset kAssets[] = {
${entries.join("\n")}
};

}  // namespace

std::span<const PageAsset> page_assets() {
  return kAssets;
}

}  // namespace biotomy::acquisition
`;
}

const [dist, output] = process.argv.slice(2);
if (!dist || !output) {
  console.error("embed_assets: give the folder that Vite wrote and the source to write");
  process.exit(2);
}
writeFileSync(output, sourceOf(assetsOf(dist)));
