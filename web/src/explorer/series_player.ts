import { batch, computed, signal } from "@preact/signals";

import { getJson, isAbort, sentenceOf } from "../api/client";
import type { ExplorerState } from "./explorer_state";
import { centre } from "./geometry/cuboid";
import type { Cuboid } from "./geometry/cuboid";
import { along, centroid, dot } from "./geometry/vector3";
import { placePlane } from "./plane_state";
import type { PlaneDefinition } from "./plane_state";
import { choicesQuery, queryText } from "./section_query";
import type { Query } from "./section_query";
import type { SectionPicture } from "./section_record";
import { fetchPicture, retryAfter } from "./section_fetch";
import { defaultSeries, framePixel, planeOf, seriesQuery } from "./series_choice";
import type { SeriesChoice, SeriesFrame } from "./series_choice";

export const speeds = [2, 5, 10, 15, 25]; // frames in a second
const atOnce = 2; // requests
const ahead = 12; // frames that are fetched before they are shown
const kept = 48; // pictures in memory
const playedSide = 720; // pixels of a frame while it plays
const rest_ms = 250;

/** Plays a series: frames are fetched before it is their turn, and shown in time where they came. */
export class SeriesPlayer {
  readonly choice = signal<SeriesChoice>(defaultSeries);
  readonly frames = signal<SeriesFrame[]>([]);
  readonly index = signal(0);
  readonly playing = signal(false);
  readonly speed = signal(10);
  readonly waiting = signal(false); // for the frame whose turn it is
  readonly failure = signal("");
  readonly current = computed(() => this.frames.value[this.index.value] ?? null);

  private query: Query = {};
  private loaded = ""; // what the frames are of
  private pixel = 1; // of the screen
  private pictures = new Map<number, SectionPicture | null>(); // null: the plane misses the block
  private flights = new Map<number, AbortController>();
  private abort = new AbortController();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private restTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly state: ExplorerState) {}

  async play(): Promise<void> {
    if (!(await this.load())) return;
    clearTimeout(this.restTimer);
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
    this.index.value = index;
    this.show();
    this.fetchAhead();
    this.sharpenAtRest();
  }

  /** Back to the plane that was shown before. */
  close(): void {
    clearTimeout(this.timer);
    clearTimeout(this.restTimer);
    this.abort.abort();
    this.abort = new AbortController();
    this.flights.clear();
    batch(() => {
      this.playing.value = false;
      this.waiting.value = false;
      this.frames.value = [];
      this.index.value = 0;
      this.state.frame.value = null;
    });
    for (const picture of this.pictures.values()) picture?.image.close();
    this.pictures.clear();
    this.loaded = "";
  }

  /** Goes on with the plane of the frame that is shown. */
  cutHere(): void {
    const placed = this.state.frame.value?.placed;
    if (!placed) return;
    const { plane, polygon } = placed;
    const through = polygon.length < 3 ? placed.through : centroid(polygon);
    this.close();
    this.state.move({ kind: "normal", normal: plane.normal, through });
  }

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
    this.failure.value = "";
    try {
      const { frames } = await getJson<{ frames: SeriesFrame[] }>(
        `/api/v1/series/frames?${queryText(query)}`,
        this.abort.signal,
      );
      const { width, height } = this.state.panel.value;
      this.pixel = framePixel(this.choice.value, choices.basis, frames, cuboid, width, height);
      this.query = { ...query, ...choicesQuery(choices) };
      this.loaded = name;
      this.frames.value = frames;
      for (const { cuts, index } of frames) if (!cuts) this.pictures.set(index, null);
      return frames.length > 0;
    } catch (error) {
      if (!isAbort(error)) this.failure.value = sentenceOf(error);
      return false;
    }
  }

  private step(): void {
    if (!this.playing.value) return;
    const shown = this.show();
    this.waiting.value = !shown;
    this.fetchAhead();
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

  /** False while the frame has not come. */
  private show(): boolean {
    const index = this.index.value;
    const picture = this.pictures.get(index);
    if (picture) this.present(picture, index);
    return picture !== undefined;
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

  private fetchAhead(): void {
    const wanted = Array.from({ length: ahead }, (_, i) => this.index.value + i).filter(
      (index) => index < this.frames.value.length && !this.pictures.has(index),
    );
    for (const [index, flight] of this.flights) {
      if (wanted.includes(index)) continue;
      flight.abort();
      this.flights.delete(index);
    }
    for (const index of wanted) {
      if (this.flights.size >= atOnce) return;
      if (!this.flights.has(index)) void this.fetch(index);
    }
  }

  private async fetch(index: number): Promise<void> {
    const flight = new AbortController();
    this.flights.set(index, flight);
    try {
      const picture = await this.picture(index, false, flight.signal);
      if (this.flights.get(index) !== flight) picture.image.close();
      else this.keep(index, picture);
    } catch (error) {
      if (isAbort(error) || this.flights.get(index) !== flight) return;
      const seconds = retryAfter(error);
      if (seconds !== null) await new Promise((done) => setTimeout(done, seconds * 1000));
      else this.keep(index, null);
    }
    if (this.flights.get(index) !== flight) return;
    this.flights.delete(index);
    if (index === this.index.value && this.waiting.value) this.step();
    else if (index === this.index.value && !this.playing.value) this.show();
    this.fetchAhead();
  }

  private async picture(
    index: number,
    sharp: boolean,
    signal: AbortSignal,
  ): Promise<SectionPicture> {
    const { width, height } = this.state.panel.value;
    const part = sharp ? 1 : Math.min(1, playedSide / Math.max(width, height));
    const query: Query = {
      ...this.query,
      index: String(index),
      fit: `${Math.ceil(width * part)}x${Math.ceil(height * part)}`,
      ...(sharp ? { format: "png" } : { format: "jpeg", quality: "85" }),
    };
    const got = await fetchPicture(`/api/v1/series/frame?${queryText(query)}`, signal);
    return { ...got, sharp, whole: true };
  }

  private keep(index: number, picture: SectionPicture | null): void {
    this.pictures.set(index, picture);
    const shown = this.state.frame.value?.picture;
    for (const [old, other] of this.pictures) {
      if (this.pictures.size <= kept) return;
      if (other === null || other === shown) continue;
      this.pictures.delete(old);
      other.image.close();
    }
  }

  private sharpenAtRest(): void {
    clearTimeout(this.restTimer);
    this.restTimer = setTimeout(() => void this.sharpen(), rest_ms);
  }

  private async sharpen(): Promise<void> {
    const index = this.index.value;
    if (this.playing.value || !this.frames.value[index]?.cuts) return;
    try {
      const picture = await this.picture(index, true, this.abort.signal);
      if (this.playing.value || index !== this.index.value || !this.frames.value.length) {
        picture.image.close();
        return;
      }
      const before = this.pictures.get(index);
      this.present(picture, index);
      this.pictures.set(index, picture);
      before?.image.close();
    } catch (error) {
      if (!isAbort(error) && retryAfter(error) !== null) this.sharpenAtRest();
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
