// @vitest-environment happy-dom
import { describe, expect, it } from "vitest";

import { keepsKey, layerKey } from "../../src/layers/layer_keys";

const pressed = (key: string, held: Partial<Record<string, boolean>> = {}) => ({
  key,
  shiftKey: false,
  ctrlKey: false,
  altKey: false,
  metaKey: false,
  ...held,
});

describe("a key", () => {
  it("turns to another layer", () => {
    expect(layerKey(pressed("ArrowLeft"))).toEqual({ kind: "step", by: -1 });
    expect(layerKey(pressed("PageDown"))).toEqual({ kind: "page", by: 1 });
    expect(layerKey(pressed("End"))).toEqual({ kind: "last" });
  });

  it("moves the picture with Shift", () => {
    const key = layerKey(pressed("ArrowUp", { shiftKey: true }));
    expect(key).toEqual({ kind: "shift", parts: { x: 0, y: -0.25 } });
    expect(layerKey(pressed("ArrowUp"))).toBeNull();
  });

  it("zooms, whether + needs Shift or not", () => {
    expect(layerKey(pressed("+"))).toEqual({ kind: "larger" });
    expect(layerKey(pressed("+", { shiftKey: true }))).toEqual({ kind: "larger" });
    expect(layerKey(pressed("="))).toEqual({ kind: "larger" });
    expect(layerKey(pressed("0"))).toEqual({ kind: "whole" });
  });

  it("is the browser's with Ctrl, Alt or the system's key", () => {
    expect(layerKey(pressed("+", { ctrlKey: true }))).toBeNull();
    expect(layerKey(pressed("ArrowLeft", { altKey: true }))).toBeNull();
    expect(layerKey(pressed("ArrowLeft", { metaKey: true }))).toBeNull();
  });

  it("means nothing when the page has no use for it", () => {
    expect(layerKey(pressed("q"))).toBeNull();
    expect(layerKey(pressed("toString"))).toBeNull();
  });
});

describe("an element", () => {
  document.body.innerHTML = `
    <div class="layer-panel"><button id="attempt"></button><div class="table-scroll" id="table"></div></div>
    <input type="number" id="number" /><input type="checkbox" id="switch" />
    <dialog><button id="close"></button></dialog><canvas id="picture"></canvas>`;
  const element = (id: string) => document.getElementById(id);
  const step = { kind: "step", by: 1 } as const;
  const last = { kind: "last" } as const;

  it("keeps the keys that it needs itself", () => {
    expect(keepsKey(element("number"), step)).toBe(true);
    expect(keepsKey(element("table"), step)).toBe(true);
    expect(keepsKey(element("close"), step)).toBe(true);
    expect(keepsKey(element("attempt"), last)).toBe(true);
  });

  it("leaves the others to the view", () => {
    expect(keepsKey(element("attempt"), step)).toBe(false);
    expect(keepsKey(element("switch"), step)).toBe(false);
    expect(keepsKey(element("picture"), last)).toBe(false);
    expect(keepsKey(null, last)).toBe(false);
  });
});
