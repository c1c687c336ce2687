// Serves folders on 127.0.0.1, each below its own name, as a plain web server does that lets
// everybody read: GET and HEAD, one byte range, CORS.
import fs from "node:fs";
import http from "node:http";
import path from "node:path";

const kinds = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json" };

/** The bytes that a Range header asks for, [first, end); nothing when there are none. */
function range(header, size) {
  const [, first, last] = /^bytes=(\d*)-(\d*)$/.exec(header) ?? [];
  if (!first && !last) return undefined;
  const begin = first ? Number(first) : Math.max(0, size - Number(last));
  const end = first && last ? Math.min(size, Number(last) + 1) : size;
  return begin < end ? [begin, end] : undefined;
}

function answer(folders, request, response) {
  response.setHeader("Access-Control-Allow-Origin", "*");
  response.setHeader("Access-Control-Allow-Headers", "Range");
  response.setHeader("Access-Control-Expose-Headers", "Content-Range");
  const [, name, ...rest] = decodeURIComponent(new URL(request.url, "http://x").pathname).split("/");
  const file = folders[name] && path.join(folders[name], ...rest);
  if (!file || rest.includes("..") || !fs.statSync(file, { throwIfNoEntry: false })?.isFile()) {
    return response.writeHead(request.method === "OPTIONS" ? 204 : 404).end();
  }
  const { size } = fs.statSync(file);
  response.setHeader("Content-Type", kinds[path.extname(file)] ?? "application/octet-stream");
  response.setHeader("Accept-Ranges", "bytes");
  let [begin, end] = [0, size];
  if (request.headers.range) {
    const wanted = range(request.headers.range, size);
    if (!wanted) return response.writeHead(416, { "Content-Range": `bytes */${size}` }).end();
    [begin, end] = wanted;
    response.writeHead(206, { "Content-Range": `bytes ${begin}-${end - 1}/${size}`, "Content-Length": end - begin });
  } else {
    response.writeHead(200, { "Content-Length": size });
  }
  if (request.method === "HEAD" || begin === end) return response.end();
  fs.createReadStream(file, { start: begin, end: end - 1 }).pipe(response);
}

/** { origin, close } */
export function serve(folders) {
  const server = http.createServer((request, response) => answer(folders, request, response));
  return new Promise((resolve) =>
    server.listen(0, "127.0.0.1", () =>
      resolve({ origin: `http://127.0.0.1:${server.address().port}`, close: () => server.close() })));
}
