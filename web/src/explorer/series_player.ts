import { batch, computed, signal } from "@preact/signals";

import { getJson, isAbort, sentenceOf } from "../api/client";
import type { ExplorerState } from "./explorer_state";
import { centre } from "./geometry/cuboid";
import type { Cuboid } from "./geometry/cuboid";
import { along, dot } from "./geometry/vector3";
import { placePlane, tidied } from "./plane_state";
import type { PlaneDefinition } from "./plane_state";
import { choicesQuery, queryText } from "./section_query";
import type { Query } from "./section_query";
import type { SectionPicture } from "./section_record";
import { busyWait_ms, fetchPicture } from "./section_fetch";
import { defaultSeries, framePixel, planeOf, seriesQuery } from "./series_choice";
import type { SeriesChoice, SeriesFrame } from "./series_choice";
import { SeriesPictures } from "./series_pictures";

export const speeds = [2, 5, 10, 15, 25]; // frames in a second
const playedSide = 720; // pixels of a frame while it plays
const rest_ms = 250;

/** Plays a series: shows its frames in time, where they have come. */
export class SeriesPlayer {
  readonly choice = signal<SeriesChoice>(defaultSeries);
  readonly frames = signal<SeriesFrame[]>([]);
  readonly index = signal(0);
  readonly playing = signal(false);
  readonly speed = signal(10);
  readonly waiting = signal(false); // for the frame whose turn it is
  readonly failure = signal("");
  readonly current = computed(() => this.frames.value[this.index.value] ?? null);

  private loaded = ""; // what the frames are of
  private pixel = 1; // of the screen
  private pictures: SeriesPictures | null = null;
  private loading = new AbortController();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private restTimer: ReturnType<typeof setTimeout> | undefined;
  private rest = new AbortController(); // of the hand, at one frame

  constructor(private readonly state: ExplorerState) {}

  async play(): Promise<void> {
    if (!(await this.load())) return;
    this.endRest();
    this.forgive();
    if (this.index.value + 1 >= this.frames.value.length) this.index.value = 0;
    this.playing.value = true;
    this.step();
  }

  pause(): void {
    this.playing.value = false;
    clearTimeout(this.timer);
    this.sharpenAtRest();
  }

  async scrub(index: number): Promise<void> {
    if (this.playing.value) this.pause();
    if (!(await this.load())) return;
    this.forgive();
    this.index.value = index;
    this.show();
    this.pictures?.wantFrom(index);
    this.sharpenAtRest();
  }

  /** Back to the plane that was shown before. */
  close(): void {
    clearTimeout(this.timer);
    this.endRest();
    this.loading.abort();
    batch(() => {
      this.playing.value = false;
      this.waiting.value = false;
      this.failure.value = "";
      this.frames.value = [];
      this.index.value = 0;
      this.state.frame.value = null;
    });
    this.pictures?.close();
    this.pictures = null;
    this.loaded = "";
  }

  /** Goes on with the plane of the frame that is shown. */
  cutHere(): void {
    const placed = this.state.frame.value?.placed;
    if (!placed) return;
    this.close();
    this.state.move(tidied(placed));
  }

  /** False where there is no series, or another one was asked for meanwhile. */
  private async load(): Promise<boolean> {
    const cuboid = this.state.cuboid.value;
    const placed = this.state.placed.value;
    if (!cuboid || !placed) return false;
    const choices = this.state.choices.value;
    const series = seriesQuery(this.choice.value, placed, cuboid);
    const query = { ...series, ...(choices.basis === "xz" ? { basis: "xz" } : {}) };
    const name = JSON.stringify([query, choices, this.state.generation.value]);
    if (name === this.loaded && this.frames.value.length > 0) return true;
    this.close();
    const { signal } = (this.loading = new AbortController());
    try {
      const { frames } = await getJson<{ frames: SeriesFrame[] }>(
        `/api/v1/series/frames?${queryText(query)}`,
        signal,
      );
      if (signal.aborted) return false;
      const { width, height } = this.state.panel.value;
      this.pixel = framePixel(this.choice.value, choices.basis, frames, cuboid, width, height);
      this.pictures = this.picturesOf(frames, { ...query, ...choicesQuery(choices) });
      this.loaded = name;
      this.frames.value = frames;
      return frames.length > 0;
    } catch (error) {
      if (!isAbort(error)) this.failure.value = sentenceOf(error);
      return false;
    }
  }

  private picturesOf(frames: readonly SeriesFrame[], query: Query): SeriesPictures {
    return new SeriesPictures({
      cuts: frames.map(({ cuts }) => cuts),
      fetch: (index, sharp, signal) =>
        this.fetch({ ...query, index: String(index) }, sharp, signal),
      came: (index) => this.came(index),
      isShown: (picture) => picture === this.state.frame.value?.picture,
    });
  }

  /** What failed before is tried once more. */
  private forgive(): void {
    this.failure.value = "";
    this.pictures?.forgive();
  }

  private step(): void {
    if (!this.playing.value) return;
    const failure = this.pictures?.failure(this.index.value);
    if (failure !== undefined) {
      this.failure.value = sentenceOf(failure);
      this.waiting.value = false;
      this.pause();
      return;
    }
    const shown = this.show();
    this.waiting.value = !shown;
    this.pictures?.wantFrom(this.index.value);
    if (!shown) return; // it goes on when the frame has come
    this.timer = setTimeout(() => {
      if (this.index.value + 1 >= this.frames.value.length) {
        this.pause();
        return;
      }
      this.index.value += 1;
      this.step();
    }, 1000 / this.speed.value);
  }

  private came(index: number): void {
    if (index !== this.index.value) return;
    if (this.waiting.value) this.step();
    else if (!this.playing.value) this.show();
  }

  /** False while the frame has not come. */
  private show(): boolean {
    const index = this.index.value;
    const picture = this.pictures?.at(index);
    if (picture) this.present(picture, index);
    return this.pictures?.has(index) ?? false;
  }

  private present(picture: SectionPicture, index: number): void {
    const cuboid = this.state.cuboid.value;
    const frame = this.frames.value[index];
    const placed = cuboid && frame && placePlane(definitionOf(frame, cuboid), cuboid);
    if (!placed) return;
    // The server's pixel of a sharp picture is nearly this one; then it is the screen's as well.
    const { pixel_um } = picture.record;
    const same = picture.sharp && Math.abs(pixel_um / this.pixel - 1) < 0.01;
    this.state.frame.value = { picture, placed, pixel: same ? pixel_um : this.pixel };
  }

  private async fetch(frame: Query, sharp: boolean, signal: AbortSignal): Promise<SectionPicture> {
    const { width, height } = this.state.panel.value;
    const part = sharp ? 1 : Math.min(1, playedSide / Math.max(width, height));
    const query: Query = {
      ...frame,
      fit: `${Math.ceil(width * part)}x${Math.ceil(height * part)}`,
      ...(sharp ? { format: "png" } : { format: "jpeg", quality: "85" }),
    };
    const got = await fetchPicture(`/api/v1/series/frame?${queryText(query)}`, signal);
    return { ...got, sharp, whole: true };
  }

  private sharpenAtRest(wait_ms = rest_ms): void {
    this.endRest();
    const { signal } = (this.rest = new AbortController());
    this.restTimer = setTimeout(() => void this.sharpen(signal), wait_ms);
  }

  /** The sharp picture of the frame is not waited for any more. */
  private endRest(): void {
    clearTimeout(this.restTimer);
    this.rest.abort();
  }

  private async sharpen(signal: AbortSignal): Promise<void> {
    const { pictures } = this;
    const index = this.index.value;
    if (!pictures || !this.frames.value[index]?.cuts) return;
    try {
      const picture = await pictures.sharpened(index, signal);
      this.present(picture, index);
      pictures.put(index, picture);
    } catch (error) {
      if (signal.aborted) return;
      const wait = busyWait_ms(error);
      if (wait !== null) this.sharpenAtRest(Math.max(wait, rest_ms));
      else this.failure.value = sentenceOf(error);
    }
  }
}

/** Through the point of the plane that is nearest to the block's middle. */
function definitionOf(frame: SeriesFrame, cuboid: Cuboid): PlaneDefinition {
  const { normal, offset } = planeOf(frame);
  const middle = centre(cuboid);
  const through = along(middle, -(dot(normal, middle) + offset), normal);
  return { kind: "normal", normal, through };
}
