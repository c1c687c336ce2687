// docs/openapi.yaml as a judge of answers.
import assert from "node:assert/strict";
import fs from "node:fs";
import Ajv2020 from "ajv/dist/2020.js";
import { parse } from "yaml";

const file = process.env.BIOTOMY_OPENAPI;
const methods = ["get", "post", "put", "patch", "delete", "options"];

export const contract = parse(fs.readFileSync(file, "utf8"));

/** A client may take what it does not know; what a server says has to be written down. */
function closed(node) {
  if (Array.isArray(node)) return node.map(closed);
  if (node === null || typeof node !== "object") return node;
  const copy = Object.fromEntries(Object.entries(node).map(([key, value]) => [key, closed(value)]));
  // A property may itself be called "properties", but then its value is a schema.
  const isSchema = copy.properties && typeof copy.properties === "object" && !copy.$ref;
  if (isSchema && copy.additionalProperties === undefined) copy.additionalProperties = false;
  return copy;
}

const ajv = new Ajv2020({ strict: false, allErrors: true, validateSchema: false });
ajv.addSchema(closed(contract), "contract");

const pointer = (...steps) =>
  steps.map((step) => `/${String(step).replaceAll("~", "~0").replaceAll("/", "~1")}`).join("");

/** What a reference leads to, and where that is. */
function resolved(node, at) {
  if (!node?.$ref) return [node, at];
  const steps = node.$ref.slice(2).split("/");
  return [steps.reduce((inner, step) => inner[step], contract), pointer(...steps)];
}

function validate(at, value, where) {
  const check = ajv.compile({ $ref: `contract#${encodeURI(at)}` });
  if (check(value)) return;
  const faults = check.errors.map(
    ({ instancePath, message, params }) => `${instancePath} ${message} ${JSON.stringify(params)}`,
  );
  assert.fail(`${where}: ${faults.join("; ")}\n${JSON.stringify(value).slice(0, 2000)}`);
}

/** Fails unless `value` is what the schema of that name says. */
export function checkNamed(name, value, where) {
  validate(pointer("components", "schemas", name), value, where);
}

/** Every operation: its path, method and the rest of it, parameters of the path included. */
export const operations = Object.entries(contract.paths).flatMap(([path, item]) =>
  methods
    .filter((method) => item[method])
    .map((method) => ({
      path,
      method,
      ...item[method],
      parameters: [...(item.parameters ?? []), ...(item[method].parameters ?? [])].map(
        (parameter) => resolved(parameter)[0],
      ),
    })),
);

/** Methods in the document for a path, in capitals. */
export function allowed(path) {
  return methods.filter((method) => contract.paths[path][method]).map((m) => m.toUpperCase());
}

/** Whether a path such as /api/v1/layers/3 is one of the document's. */
export function isDocumented(path) {
  return Object.keys(contract.paths).some((template) => {
    const [head, ...rest] = template.split("/{path}");
    if (rest.length) return path.startsWith(`${head}/`);
    const steps = template.split("/");
    const asked = path.split("/");
    return (
      steps.length === asked.length &&
      steps.every((step, i) => (step.startsWith("{") ? asked[i] !== "" : step === asked[i]))
    );
  });
}

const hasNoBody = (method, status) => method === "head" || status === 204 || status === 304;

/** Fails unless status, headers, content type and content are as documented for the operation.
 * Gives the JSON, or the bytes of what is none. */
export async function checkAnswer({ path, method, responses }, response, where) {
  const status = String(response.status);
  assert.ok(responses[status] ?? responses.default, `${where}: ${status} is not documented`);
  const key = responses[status] ? status : "default";
  const from = pointer("paths", path, method, "responses", key);
  const [answer, at] = resolved(responses[key], from);

  for (const [name, header] of Object.entries(answer.headers ?? {})) {
    const said = response.headers.get(name);
    if (said === null) {
      assert.ok(!header.required, `${where}: ${status} without the header ${name}`);
      continue;
    }
    if (header.content) {
      const schema = at + pointer("headers", name, "content", "application/json", "schema");
      validate(schema, JSON.parse(said), `${where}: header ${name}`);
    } else {
      const number = header.schema.type === "integer";
      validate(
        at + pointer("headers", name, "schema"),
        number ? Number(said) : said,
        `${where}: header ${name}`,
      );
    }
  }

  const body = Buffer.from(await response.arrayBuffer());
  if (hasNoBody(method, response.status)) {
    assert.equal(body.length, 0, `${where}: ${status} with a body`);
    return undefined;
  }
  const type = (response.headers.get("content-type") ?? "").split(";")[0];
  const types = Object.keys(answer.content ?? {});
  assert.ok(
    types.includes(type) || types.includes("*/*"),
    `${where}: ${status} is ${type}, not ${types}`,
  );
  if (type !== "application/json" || response.status === 206) {
    assert.ok(body.length > 0, `${where}: ${status} without a body`);
    return body;
  }
  const value = JSON.parse(body.toString("utf8"));
  validate(at + pointer("content", type, "schema"), value, where);
  return value;
}
