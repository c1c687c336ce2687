// The group's metadata against the published JSON schemas of OME-Zarr 0.5, and its scales and
// translations against the rule.
import fs from "node:fs";
import path from "node:path";
import Ajv from "ajv/dist/2020.js";
import { check, skip } from "./table.mjs";

const read = (file) => JSON.parse(fs.readFileSync(file, "utf8"));

function validator(folder, name) {
  const ajv = new Ajv({ strict: false, allErrors: true, validateFormats: false });
  for (const file of fs.readdirSync(folder)) ajv.addSchema(read(path.join(folder, file)));
  return ajv.getSchema(read(path.join(folder, name)).$id);
}

export async function checkMetadata(name, store, expected, spacing, schemas) {
  const attributes = read(path.join(store, "zarr.json")).attributes;
  for (const schema of ["image.schema", "strict_image.schema"]) {
    const folder = path.join(schemas, "0.5", "schemas");
    if (!fs.existsSync(path.join(folder, schema))) {
      skip(name, `OME-Zarr 0.5 ${schema}`, "the schemas are not in ../shared/validators");
      continue;
    }
    await check(name, `OME-Zarr 0.5 ${schema}`, () => {
      const validate = validator(folder, schema);
      if (!validate(attributes)) {
        const [first] = validate.errors;
        throw new Error(`${first.instancePath} ${first.message}`);
      }
    });
  }
  await check(name, "levels, scales and translations", () => {
    const [{ datasets, axes }] = attributes.ome.multiscales;
    const places = axes.map((axis) => `${axis.name}:${axis.unit ?? axis.type}`).join(" ");
    if (places !== "c:channel z:micrometer y:micrometer x:micrometer") throw new Error(places);
    if (datasets.length !== expected.length) {
      throw new Error(`${datasets.length} levels, expected ${expected.length}`);
    }
    datasets.forEach(({ path: level, coordinateTransformations: list }, number) => {
      const scale = [1, ...expected[number].map((f, axis) => f * spacing[axis])];
      const shift = [0, ...expected[number].map((f, axis) => ((f - 1) / 2) * spacing[axis])];
      const found = Object.fromEntries(list.map((each) => [each.type, each[each.type]]));
      const near = (a, b) => a.every((value, i) => Math.abs(value - b[i]) <= 1e-9 * Math.abs(b[i]));
      if (!near(found.scale, scale)) throw new Error(`level ${level}: scale ${found.scale}`);
      if (!near(found.translation ?? [0, 0, 0, 0], shift)) {
        throw new Error(`level ${level}: translation ${found.translation}, expected ${shift}`);
      }
    });
    return expected.map((f) => f.join("×")).join(", ");
  });
}
