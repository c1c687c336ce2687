// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { service } from "../../src/api/live";
import type { ExportJob, Service } from "../../src/api/types";
import { ExportJobs } from "../../src/explorer/export_jobs";
import { ExportList } from "../../src/explorer/ExportList";

const aJob = (id: string, state: ExportJob["state"] = "done"): ExportJob => ({
  id,
  kind: "section",
  state,
  done: 9,
  total: 9,
  unit: "rows",
  seconds_left: null,
  sentence: state,
  created_at: "2026-11-22T03:04:05Z",
  command: "biotomy section /data/knee --normal=0,0,1 --through=0,0,400 --output=section.png",
  files: [],
});

describe("the list of exports", () => {
  let exports: ExportJobs;
  const rows = () => [...document.querySelectorAll<HTMLElement>('[data-role="export"]')];
  const remove = (row: number) =>
    act(async () => {
      const button = [...rows()[row].querySelectorAll("button")].at(-1)!;
      button.focus();
      button.click();
      await new Promise((resolve) => setTimeout(resolve));
    });

  beforeEach(() => {
    vi.stubGlobal("fetch", async () => new Response("{}"));
    exports = new ExportJobs();
    exports.jobs.value = [aJob("a"), aJob("b"), aJob("c", "failed")];
    void act(() => render(<ExportList exports={exports} />, document.body));
  });
  afterEach(() => {
    render(null, document.body);
    service.value = null;
    vi.unstubAllGlobals();
  });

  it("tells one from another by when and how it was made, and how it ended if not well", () => {
    const [done, , failed] = rows().map((row) => row.textContent);
    expect(done).toMatch(/^Section on .*--normal=0,0,1 --through=0,0,400/);
    expect(done).not.toMatch(/done|--output|knee/);
    expect(failed).toContain("failed");
  });

  it("removes nothing at the first press", async () => {
    await remove(0);
    expect(rows()).toHaveLength(3);
    expect(rows()[0].textContent).toContain("Remove for good");
  });

  it("fetches a file once where reading needs a token, and says that it is on its way", async () => {
    const file = {
      name: "section.png",
      bytes: 2_000_000,
      url: "/api/v1/exports/a/files/section.png",
    };
    service.value = { reading: "token" } as Service;
    let answer = (_: Response) => {};
    const fetched = vi.fn(() => new Promise<Response>((resolve) => (answer = resolve)));
    vi.stubGlobal("fetch", fetched);
    await act(() => void (exports.jobs.value = [{ ...aJob("a"), files: [file] }]));
    const button = () => rows()[0].querySelector("button")!;
    await act(() => button().click());
    expect(button().textContent).toMatch(/^Downloading section.png/);
    await act(() => button().click());
    expect(fetched).toHaveBeenCalledTimes(1);
    await act(async () => {
      answer(new Response("{}", { status: 404 }));
      await new Promise((resolve) => setTimeout(resolve));
    });
    expect(button().textContent).toMatch(/^Download section.png/);
    expect(exports.failure.value).not.toBe("");
  });

  it("keeps the focus in the list when a row is removed", async () => {
    await remove(0);
    await remove(0);
    expect(rows().map(({ dataset }) => dataset.id)).toEqual(["b", "c"]);
    expect(rows()[0].contains(document.activeElement)).toBe(true);
    await remove(1);
    await remove(1);
    expect(document.activeElement?.textContent).toBe("Exports");
  });
});
