import { batch, computed, signal } from "@preact/signals";

import type { Sample } from "../api/types";
import { depthOfLayer, extent, leastSpacing } from "./geometry/cuboid";
import type { Cuboid } from "./geometry/cuboid";
import type { PlaneRectangle } from "./geometry/plane_rectangle";
import type { Vector3 } from "./geometry/vector3";
import { startingCamera } from "./orbit_camera";
import type { OrbitCamera } from "./orbit_camera";
import { alongLayers, diagonal, placePlane, tidied } from "./plane_state";
import type { PlacedPlane, PlaneDefinition } from "./plane_state";
import { defaultChoices } from "./section_choices";
import type { SectionChoices, Theta } from "./section_choices";
import type { Wish } from "./section_loader";
import { choicesQuery, planeQuery } from "./section_query";
import type { Query } from "./section_query";
import { rectangleOf, sampleAt } from "./section_record";
import type { SectionPicture } from "./section_record";
import { closeupWindow, evenPixel, fittingPixel, placementOf, wholeWindow } from "./section_window";
import type { Placement, SectionWindow } from "./section_window";
import { wishFor } from "./section_wish";
import { isKnownHere, thetaFrame } from "./theta_frame";
import type { Closeup, ExplorerView } from "./view_hash";

/** The room that a section is shown in, in pixels of the screen. */
export interface Panel {
  width: number;
  height: number;
  ratio: number; // of a CSS pixel
}

/** A frame of a series, shown in place of the section while it plays. */
export interface ShownFrame {
  picture: SectionPicture;
  placed: PlacedPlane;
  pixel: number; // of the screen, the same for all frames
}

/** What the explorer shows, in one place: every control reads it from here and changes it here. */
export class ExplorerState {
  readonly sample = signal<Sample | null>(null);
  readonly layersPresent = signal(0);
  readonly generation = signal(0);

  readonly definition = signal<PlaneDefinition | null>(null);
  readonly azimuth = signal(0); // kept while the plane lies along the layers
  readonly choices = signal<SectionChoices>(defaultChoices);
  readonly around = signal(false);
  readonly closeup = signal<Closeup | null>(null);
  readonly follow = signal(false);
  readonly camera = signal<OrbitCamera>(startingCamera);
  readonly panel = signal<Panel>({ width: 0, height: 0, ratio: 1 });

  readonly picture = signal<SectionPicture | null>(null);
  readonly inscribed = signal<{ of: string; rectangle: PlaneRectangle } | null>(null);
  readonly frame = signal<ShownFrame | null>(null);
  readonly settled = signal(false); // the picture is the sharp one of what is chosen
  readonly failure = signal("");

  readonly cuboid = computed<Cuboid | null>(() => {
    const sample = this.sample.value;
    return sample && { size: sample.size, spacing: sample.spacing_um };
  });
  readonly far = computed<Vector3>(() => {
    const cuboid = this.cuboid.value;
    return cuboid ? extent(cuboid) : [1, 1, 1];
  });

  /** Of the newest face; a block of a single layer yet has its whole depth. */
  readonly depthPresent = computed(() => {
    const cuboid = this.cuboid.value;
    const layers = this.layersPresent.value;
    return cuboid ? depthOfLayer(cuboid, layers > 1 ? layers : cuboid.size[2]) : 0;
  });

  readonly placed = computed<PlacedPlane | null>(() => {
    const cuboid = this.cuboid.value;
    const definition = this.definition.value;
    return cuboid && definition && placePlane(definition, cuboid, this.azimuth.value);
  });

  /** The plane that is shown: the series' own while one plays. */
  readonly shownPlane = computed(() => this.frame.value?.placed ?? this.placed.value);
  readonly shownDefinition = computed<PlaneDefinition | null>(() => {
    const frame = this.frame.value;
    return frame ? tidied(frame.placed) : this.definition.value;
  });
  readonly shownPicture = computed(() => this.frame.value?.picture ?? this.picture.value);

  /** What names the section as it is chosen, whatever part of it is looked at. */
  readonly query = computed<Query | null>(() => {
    const definition = this.definition.value;
    return definition && { ...planeQuery(definition), ...choicesQuery(this.choices.value) };
  });

  /**
   * What names the section in the plane that is shown, which while a series plays is its frame's.
   * The axes of a frame turn with the series; those of the section are as of any section there.
   */
  readonly shownQuery = computed<Query | null>(() => {
    const definition = this.shownDefinition.value;
    return definition && { ...planeQuery(definition), ...choicesQuery(this.choices.value) };
  });

  /** The rectangle that becomes the picture; none while the server has not told of it. */
  readonly rectangle = computed<PlaneRectangle | null>(() => {
    const placed = this.placed.value;
    const { theta, basis } = this.choices.value;
    if (!placed) return null;
    if (isKnownHere(theta)) return thetaFrame(theta, placed, basis);
    const inscribed = this.inscribed.value;
    return inscribed && inscribed.of === JSON.stringify(this.query.value)
      ? inscribed.rectangle
      : null;
  });

  private readonly shownTheta = computed<Theta>(() =>
    this.around.value ? { kind: "bounding" } : this.choices.value.theta,
  );

  /** The rectangle of the section that can be looked at: in a close-up, a part of it. */
  private readonly seen = computed<PlaneRectangle | null>(() => {
    const placed = this.placed.value;
    if (!placed) return null;
    return this.around.value
      ? thetaFrame({ kind: "bounding" }, placed, this.choices.value.basis)
      : this.rectangle.value;
  });

  /** How the panel looks at the section now; none before there is a picture. */
  readonly window = computed<SectionWindow | null>(() => {
    const { width, height } = this.panel.value;
    if (width === 0 || height === 0) return null;
    const frame = this.frame.value;
    if (frame) {
      return wholeWindow(rectangleOf(frame.picture.record), width, height, frame.pixel);
    }
    const seen = this.seen.value;
    const closeup = this.closeup.value;
    if (closeup && seen) return closeupWindow(seen, width, height, closeup);
    const picture = this.picture.value;
    const cuboid = this.cuboid.value;
    const least = cuboid ? leastSpacing(cuboid) : 1;
    const fitting = (frame: PlaneRectangle) => evenPixel(fittingPixel(frame, width, height), least);
    if (!picture?.whole) return seen && wholeWindow(seen, width, height, fitting(seen));
    const { record, sharp } = picture;
    const shown = rectangleOf(record);
    const reduced = sharp && record.pixel_um > record.full.pixel_um;
    return wholeWindow(shown, width, height, reduced ? record.pixel_um : fitting(shown));
  });

  /** Where the picture lies in the panel. */
  readonly placement = computed<Placement | null>(() => {
    const window = this.window.value;
    const record = this.shownPicture.value?.record;
    if (!window || !record) return null;
    const { width, height } = record.picture;
    return placementOf(window, record.rectangle.origin_um, record.pixel_um, width, height);
  });

  /** What is to be fetched; null while nothing can be. */
  readonly wish = computed<Wish | null>(() => {
    const cuboid = this.cuboid.value;
    const placed = this.placed.value;
    if (!cuboid || !placed) return null;
    return wishFor({
      placed,
      cuboid,
      choices: { ...this.choices.value, theta: this.shownTheta.value },
      of: JSON.stringify(this.query.value),
      seen: this.seen.value,
      closeup: this.closeup.value,
      width: this.panel.value.width,
      height: this.panel.value.height,
      generation: this.generation.value,
    });
  });

  readonly view = computed<ExplorerView>(() => ({
    plane: this.definition.value,
    choices: this.choices.value,
    around: this.around.value,
    closeup: this.closeup.value,
    follow: this.follow.value,
  }));

  /** Of a frame of a series, which is always seen whole, the section in its plane. */
  readonly shownView = computed<ExplorerView>(() =>
    this.frame.value
      ? {
          ...this.view.value,
          plane: this.shownDefinition.value,
          around: false,
          closeup: null,
          follow: false,
        }
      : this.view.value,
  );

  /** Shows what a link holds. */
  open(view: ExplorerView): void {
    batch(() => {
      this.choices.value = view.choices;
      this.around.value = view.around;
      this.closeup.value = view.closeup;
      this.follow.value = view.follow;
      this.definition.value = view.plane;
      this.chooseWhereNoneIs();
    });
  }

  learn(sample: Sample): void {
    batch(() => {
      this.sample.value = sample;
      this.grow(sample);
      this.chooseWhereNoneIs();
    });
  }

  /** The sample has more layers, or other ones. */
  grow({ layers_present, generation }: { layers_present: number; generation: number }): void {
    batch(() => {
      this.layersPresent.value = layers_present;
      this.generation.value = generation;
      if (this.follow.value) this.chooseNewest();
    });
  }

  private chooseNewest(): void {
    const cuboid = this.cuboid.value;
    if (cuboid) this.definition.value = alongLayers(cuboid, Math.max(1, this.layersPresent.value));
  }

  private chooseWhereNoneIs(): void {
    const cuboid = this.cuboid.value;
    if (!cuboid) return;
    if (this.follow.value) this.chooseNewest();
    else if (!this.placed.value) this.definition.value = diagonal(cuboid, this.depthPresent.value);
  }

  /** What of the sample is at a place of the panel, in CSS pixels; none beside the picture. */
  sampleUnder([x, y]: readonly [number, number]): Vector3 | null {
    const record = this.shownPicture.value?.record;
    const placement = this.placement.value;
    if (!record || !placement) return null;
    const { ratio } = this.panel.value;
    const { width, height } = record.picture;
    const u = ((x * ratio - placement.left) / placement.width) * width - 0.5;
    const v = ((y * ratio - placement.top) / placement.height) * height - 0.5;
    const beside = u < -0.5 || v < -0.5 || u > width - 0.5 || v > height - 0.5;
    return beside ? null : sampleAt(record, u, v);
  }

  /** A definition that is of no plane changes nothing; false tells so. */
  move(definition: PlaneDefinition): boolean {
    const cuboid = this.cuboid.value;
    const placed = cuboid && placePlane(definition, cuboid, this.azimuth.value);
    if (!placed) return false;
    batch(() => {
      this.frame.value = null;
      this.follow.value = false;
      // Where an inscribed rectangle will be is not known: what a close-up saw may be outside.
      if (!isKnownHere(this.shownTheta.value)) this.closeup.value = null;
      this.definition.value = definition;
    });
    return true;
  }

  toNewest(): void {
    batch(() => {
      this.frame.value = null;
      this.follow.value = true;
      this.chooseNewest();
    });
  }

  choose(choices: Partial<SectionChoices>): void {
    batch(() => {
      this.frame.value = null;
      const { theta, basis } = { ...this.choices.value, ...choices };
      const other = choices.theta !== undefined || basis !== this.choices.value.basis;
      if (other && !(isKnownHere(theta) || this.around.value)) this.closeup.value = null;
      this.choices.value = { ...this.choices.value, ...choices };
    });
  }

  /** A picture has come, of the section that `of` names. */
  show(picture: SectionPicture, of: string): void {
    batch(() => {
      this.failure.value = "";
      this.settled.value = picture.sharp;
      if (picture.whole && !this.around.value) {
        this.inscribed.value = { of, rectangle: rectangleOf(picture.record) };
      }
      const before = this.picture.value;
      this.picture.value = picture;
      if (before !== picture) before?.image.close();
    });
  }
}
