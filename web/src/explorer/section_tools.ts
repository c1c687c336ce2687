import { signal } from "@preact/signals";

import type { Vector3 } from "./geometry/vector3";

/** What a press on the section does: look closer, measure, or draw the rectangle. */
export type SectionTool = "look" | "measure" | "rectangle";

/** Of the panel that shows the section; nothing of it is part of a link. */
export class SectionTools {
  readonly tool = signal<SectionTool>("look");
  readonly pointer = signal<readonly [number, number] | null>(null); // over it, in CSS pixels
  readonly measured = signal<{ from: Vector3; to: Vector3 | null } | null>(null);

  take(tool: SectionTool): void {
    this.tool.value = tool;
    if (tool !== "measure") this.measured.value = null;
  }

  /** The first place of a distance, or its second. */
  measure(place: Vector3): void {
    const before = this.measured.value;
    this.measured.value =
      before && !before.to ? { from: before.from, to: place } : { from: place, to: null };
  }
}
