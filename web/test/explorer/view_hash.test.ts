import { describe, expect, it } from "vitest";

import { defaultChoices, parseTheta, thetaText } from "../../src/explorer/section_choices";
import { parseView, viewQuery } from "../../src/explorer/view_hash";
import type { ExplorerView } from "../../src/explorer/view_hash";

const plain: ExplorerView = {
  plane: null,
  choices: defaultChoices,
  around: false,
  closeup: null,
  follow: false,
};

describe("the link of a view", () => {
  it.each<ExplorerView>([
    plain,
    { ...plain, follow: true },
    {
      ...plain,
      plane: {
        kind: "points",
        points: [
          [0, 0, 0],
          [9990, 0, -1.5],
          [1e-7, 10 / 3, 1580],
        ],
      },
    },
    {
      plane: { kind: "normal", normal: [1, 2, -3], through: [0.5, 4, 6] },
      choices: {
        basis: "xz",
        theta: { kind: "custom", corner: [1, 2, 3], width: 100, height: 50.5, angle: -12 },
        interpolation: "cubic",
        background: [255, 128, 0],
      },
      around: true,
      closeup: { middle: [1, 2, 3], pixel: 0.325 },
      follow: false,
    },
    { ...plain, choices: { ...defaultChoices, theta: { kind: "edge", edge: 2 } } },
  ])("opens the same view: %j", (view) => {
    expect(parseView(viewQuery(view))).toEqual(view);
  });

  it("has the parameters of `biotomy section`", () => {
    const plane = { kind: "normal", normal: [0, 0, 1], through: [1, 2, 3] } as const;
    expect(viewQuery({ ...plain, plane })).toBe("normal=0,0,1&through=1,2,3");
  });

  it("leaves out the plane where the newest face is followed", () => {
    const plane = { kind: "normal", normal: [0, 0, 1], through: [1, 2, 3] } as const;
    expect(viewQuery({ ...plain, plane, follow: true })).toBe("follow=1");
  });

  it("opens the default where it can't be read", () => {
    const broken =
      "points=1,2,3 4,5&normal=1,2&theta=edge:9&basis=yz&background=1,2,300&closeup=1,2,3,0";
    expect(parseView(broken)).toEqual(plain);
  });
});

describe("a rectangle's name", () => {
  it("is refused where the tool would refuse it", () => {
    for (const text of [
      "edge:-1",
      "edge:",
      "custom:1,2,3,4,5",
      "custom:0,0,0,0,1,0",
      "largest",
      "",
    ]) {
      expect(parseTheta(text)).toBeNull();
    }
  });

  it("comes back as it was", () => {
    for (const text of ["bounding", "inscribed", "inscribed-any", "edge:0", "custom:1,2,3,4,5,6"]) {
      expect(thetaText(parseTheta(text)!)).toBe(text);
    }
  });
});
