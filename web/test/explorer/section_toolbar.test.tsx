// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it } from "vitest";

import { service } from "../../src/api/live";
import type { Service } from "../../src/api/types";
import { ExplorerState } from "../../src/explorer/explorer_state";
import { ExportJobs } from "../../src/explorer/export_jobs";
import { SectionToolbar } from "../../src/explorer/SectionToolbar";
import { SectionTools } from "../../src/explorer/section_tools";
import { aSample } from "./a_sample";

const served = { neuroglancer: "https://neuroglancer.example", reading: "open" } as Service;
const neuroglancer = () =>
  [...document.querySelectorAll("a, button")].find((it) => /neuroglancer/.test(it.textContent!));

beforeEach(async () => {
  service.value = served;
  const state = new ExplorerState();
  state.learn(aSample);
  const parts = { state, tools: new SectionTools(), exports: new ExportJobs() };
  await act(() => render(<SectionToolbar {...parts} onExport={() => {}} />, document.body));
});
afterEach(() => {
  render(null, document.body);
  service.value = null;
});

it("opens neuroglancer", () => {
  expect(neuroglancer()?.getAttribute("href")).toContain(served.neuroglancer);
});

it("says why it can't where reading needs a token", async () => {
  await act(() => void (service.value = { ...served, reading: "token" }));
  expect(neuroglancer()?.matches("button:disabled")).toBe(true);
  expect(neuroglancer()?.getAttribute("title")).toContain("token");
});
