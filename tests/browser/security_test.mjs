// What a page of somebody else, and a stranger, get from the daemon.
import assert from "node:assert/strict";
import http from "node:http";
import net from "node:net";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { Rig } from "./rig.mjs";

let rig;
let browser;

before(async () => {
  rig = await Rig.start({ layers: 2 });
  await rig.runJob();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

/** Asks with headers that fetch() does not let one choose: {status, headers, body}. */
function rawly(path, { method = "GET", headers = {}, body } = {}) {
  return new Promise((resolve, reject) => {
    const request = http.request(rig.url + path, { method, headers }, (response) => {
      const pieces = [];
      response.on("data", (piece) => pieces.push(piece));
      response.on("end", () =>
        resolve({
          status: response.statusCode,
          headers: response.headers,
          body: Buffer.concat(pieces).toString(),
        }),
      );
    });
    request.on("error", reject);
    request.end(body);
  });
}

const foreign = "http://elsewhere.example";

test("the page's policy is strict", async () => {
  const { headers } = await rawly("/");
  const policy = Object.fromEntries(
    headers["content-security-policy"].split(";").map((part) => {
      const [name, ...values] = part.trim().split(/ +/);
      return [name, values];
    }),
  );
  assert.deepEqual(policy["default-src"], ["'none'"]);
  assert.deepEqual(policy["script-src"], ["'self'"]);
  assert.deepEqual(policy["style-src"], ["'self'"]);
  assert.deepEqual(policy["connect-src"], ["'self'"]);
  assert.deepEqual(policy["base-uri"], ["'none'"]);
  assert.deepEqual(policy["form-action"], ["'none'"]);
  assert.deepEqual(policy["frame-ancestors"], ["'none'"]);
  for (const [name, values] of Object.entries(policy)) {
    for (const value of values) {
      assert.match(value, /^('none'|'self'|blob:|data:)$/, `${name} ${value}`);
    }
  }
  for (const name of ["script-src", "connect-src", "style-src"]) {
    assert.ok(!policy[name].includes("data:") && !policy[name].includes("blob:"), name);
  }
});

test("every answer forbids guessing its type, being framed and telling where one was", async () => {
  for (const path of ["/", "/api/v1/status", "/api/v1/layers/1/image", "/api/v1/nothing"]) {
    const { headers } = await rawly(path);
    assert.equal(headers["x-content-type-options"], "nosniff", path);
    assert.equal(headers["referrer-policy"], "no-referrer", path);
    assert.match(headers["content-security-policy"], /frame-ancestors 'none'/, path);
    assert.equal(headers["cross-origin-resource-policy"], "same-origin", path);
    assert.equal(headers["access-control-allow-origin"], undefined, path);
  }
});

test("another name for this computer is refused: that is how DNS is turned against it", async () => {
  const { port } = new URL(rig.url);
  for (const host of [
    "elsewhere.example",
    `elsewhere.example:${port}`,
    "127.0.0.1.elsewhere.example",
  ]) {
    const { status, body } = await rawly("/api/v1/status", { headers: { Host: host } });
    assert.equal(status, 421, host);
    assert.ok(JSON.parse(body).error.message.length > 10);
  }
  for (const host of [`127.0.0.1:${port}`, `localhost:${port}`, `[::1]:${port}`]) {
    assert.equal((await rawly("/api/v1/status", { headers: { Host: host } })).status, 200, host);
  }
});

test("another origin may neither look nor command, with whatever token", async () => {
  const authorization = { Authorization: `Bearer ${rig.token}` };
  for (const headers of [
    { Origin: foreign },
    { Origin: "null" },
    { "Sec-Fetch-Site": "cross-site" },
  ]) {
    const look = await rawly("/api/v1/status", { headers: { ...headers, ...authorization } });
    assert.equal(look.status, 403, JSON.stringify(headers));
    const command = await rawly("/api/v1/control/start", {
      method: "POST",
      headers: { ...headers, ...authorization },
    });
    assert.equal(command.status, 403, JSON.stringify(headers));
  }
  const own = await rawly("/api/v1/status", { headers: { Origin: rig.url } });
  assert.equal(own.status, 200);
});

test("the volume is open to neuroglancer's origin, and to no other", async () => {
  const { neuroglancer } = await (await rig.ask("/api/v1/service")).json();
  const origin = new URL(neuroglancer).origin;
  const file = "/volume.ome.zarr/zarr.json";
  const allowed = await rawly(file, {
    headers: { Origin: origin, "Sec-Fetch-Site": "cross-site" },
  });
  assert.equal(allowed.status, 200);
  assert.equal(allowed.headers["access-control-allow-origin"], origin);
  const other = await rawly(file, { headers: { Origin: foreign } });
  assert.notEqual(other.headers["access-control-allow-origin"], foreign);
  assert.notEqual(other.headers["access-control-allow-origin"], "*");
  const asked = await rawly(file, {
    method: "OPTIONS",
    headers: {
      Origin: origin,
      "Access-Control-Request-Method": "GET",
      "Access-Control-Request-Headers": "range",
    },
  });
  assert.equal(asked.status, 204);
  assert.equal(asked.headers["access-control-allow-origin"], origin);
  assert.match(asked.headers["access-control-allow-headers"], /range/i);
});

test("a page of another origin gets nothing out of the browser either", async () => {
  const hostile = http.createServer((_, response) => {
    response.setHeader("Content-Type", "text/html");
    response.end("<!doctype html><title>hostile</title>");
  });
  await new Promise((resolve) => hostile.listen(0, "127.0.0.1", resolve));
  const tab = await Tab.open(browser);
  try {
    await tab.page.goto(`http://127.0.0.1:${hostile.address().port}/`);
    const got = await tab.page.evaluate(async (url) => {
      const tried = (what) =>
        what.then(
          (text) => text,
          () => "nothing",
        );
      const image = new Image();
      const shown = new Promise((resolve) => {
        image.onload = () => resolve("a picture");
        image.onerror = () => resolve("nothing");
      });
      image.src = `${url}/api/v1/layers/1/image`;
      return {
        read: await tried(fetch(`${url}/api/v1/status`).then((answer) => answer.text())),
        image: await shown,
        // What a form can send: it arrives, and is refused.
        sent: await tried(
          fetch(`${url}/api/v1/control/start`, { method: "POST", mode: "no-cors" }).then(
            ({ type }) => type,
          ),
        ),
      };
    }, rig.url);
    assert.equal(got.read, "nothing");
    assert.equal(got.image, "nothing");
    const posted = tab.answers.find(({ url }) => url.endsWith("/control/start"));
    assert.equal(posted?.status ?? 403, 403);
  } finally {
    await tab.close();
    hostile.close();
  }
});

test("a browser whose DNS was turned shows no page of ours", async () => {
  const { port } = new URL(rig.url);
  const turned = await launch(["--host-resolver-rules=MAP elsewhere.example 127.0.0.1"]);
  try {
    const tab = await Tab.open(turned);
    const answer = await tab.page.goto(`http://elsewhere.example:${port}/`);
    assert.equal(answer.status(), 421);
  } finally {
    await turned.close();
  }
});

test("what is too large is refused before it is read", async () => {
  const long = "x".repeat(100_000);
  assert.equal((await rawly(`/api/v1/section?points=${long.slice(0, 12_000)}`)).status, 414);
  assert.equal(
    (await rawly("/api/v1/status", { headers: { "X-Long": long.slice(0, 40_000) } })).status,
    431,
  );
  const posted = await rawly("/api/v1/control/pause", {
    method: "POST",
    headers: { "Content-Length": 10_000_000 },
    body: "x",
  }).catch(({ code }) => ({ status: code }));
  assert.ok([413, "ECONNRESET"].includes(posted.status), String(posted.status));
});

test("whoever says nothing is put out", async () => {
  const socket = net.connect(Number(new URL(rig.url).port), "127.0.0.1");
  socket.write("GET / HTTP/1.1\r\nHost: ");
  socket.on("error", () => {});
  await new Promise((resolve) => socket.on("close", resolve).resume());
});

test("a path does not lead out of the sample", async () => {
  for (const path of [
    "/volume.ome.zarr/../sample.toml",
    "/volume.ome.zarr/%2e%2e/sample.toml",
    "/volume.ome.zarr/..%2fjournal.sqlite",
    "/api/v1/rejected/..%2f..%2ftoken",
    "/api/v1/rejected/%2e%2e%2f%2e%2e%2ftoken",
    "/assets/../token",
    "/assets/%2e%2e%2ftoken",
    "/volume.ome.zarr/0/c/0/0/0/%00",
  ]) {
    const { status, body } = await rawly(path);
    assert.ok(status === 404 || status === 400, `${path}: ${status}`);
    assert.ok(!body.includes(rig.token) && !body.includes("[sample]"), path);
  }
});

test("no token, right or wrong, is written into the log", async () => {
  const wrong = "wrong-0123456789abcdef";
  await rig.ask("/api/v1/control/pause", { method: "POST", token: wrong });
  await rig.ask("/api/v1/control/pause", { method: "POST", token: rig.token });
  assert.match(rig.log, /refused .*wrong token/);
  for (const token of [wrong, rig.token]) assert.ok(!rig.log.includes(token));
});
