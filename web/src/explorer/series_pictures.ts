import { isAbort } from "../api/client";
import { busyWait_ms } from "./section_fetch";
import type { SectionPicture } from "./section_record";

const atOnce = 2; // requests
const ahead = 12; // frames that are fetched before they are shown
const kept = 48; // pictures in memory

export interface SeriesPicturesOptions {
  /** Whether the plane of each frame cuts the block: there is no picture of the others. */
  cuts: readonly boolean[];
  fetch: (index: number, sharp: boolean, signal: AbortSignal) => Promise<SectionPicture>;
  /** The picture of a frame has come, or will not. */
  came: (index: number) => void;
  /** It must not be given back yet. */
  isShown: (picture: SectionPicture) => boolean;
}

/** The pictures of one series: fetched before it is their turn, and a bounded number kept. */
export class SeriesPictures {
  private readonly pictures = new Map<number, SectionPicture>();
  private readonly failures = new Map<number, unknown>();
  private readonly flights = new Map<number, AbortController>();
  private from = 0;

  constructor(private readonly options: SeriesPicturesOptions) {}

  /** None where it has not come; there never is one of a plane that misses the block. */
  at(index: number): SectionPicture | undefined {
    return this.pictures.get(index);
  }

  /** The frame is as it will be: its picture is here, or there is none of it. */
  has(index: number): boolean {
    return this.pictures.has(index) || !this.options.cuts[index];
  }

  /** Why the picture of a frame will not come by itself. */
  failure(index: number): unknown {
    return this.failures.get(index);
  }

  /** What could not be had is asked for again. */
  forgive(): void {
    this.failures.clear();
  }

  /** Fetches this frame and the next ones; what is farther away is given up. */
  wantFrom(index: number): void {
    this.from = index;
    const end = Math.min(index + ahead, this.options.cuts.length);
    for (const [other, flight] of this.flights) {
      if (other >= index && other < end) continue;
      flight.abort();
      this.flights.delete(other);
    }
    for (let wanted = index; wanted < end && this.flights.size < atOnce; wanted += 1) {
      const isThere = this.has(wanted) || this.flights.has(wanted) || this.failures.has(wanted);
      if (!isThere) void this.load(wanted);
    }
  }

  /** The picture at the screen's resolution, which takes the place of the one there was. */
  async sharpened(index: number, signal: AbortSignal): Promise<SectionPicture> {
    const picture = await this.options.fetch(index, true, signal);
    if (signal.aborted) {
      picture.image.close();
      throw new DOMException("nobody rests at the frame any more", "AbortError");
    }
    return picture;
  }

  /** Keeps a picture that was sharpened. */
  put(index: number, picture: SectionPicture): void {
    const before = this.pictures.get(index);
    this.pictures.set(index, picture);
    before?.image.close();
    for (const [old, other] of this.pictures) {
      if (this.pictures.size <= kept) return;
      if (old === index || this.options.isShown(other)) continue;
      this.pictures.delete(old);
      other.image.close();
    }
  }

  close(): void {
    for (const flight of this.flights.values()) flight.abort();
    this.flights.clear();
    for (const picture of this.pictures.values()) picture.image.close();
    this.pictures.clear();
  }

  private async load(index: number): Promise<void> {
    const flight = new AbortController();
    this.flights.set(index, flight);
    const isWanted = () => this.flights.get(index) === flight;
    try {
      const picture = await this.options.fetch(index, false, flight.signal);
      if (isWanted()) this.put(index, picture);
      else picture.image.close();
    } catch (error) {
      if (isAbort(error) || !isWanted()) return;
      const wait = busyWait_ms(error);
      if (wait === null) this.failures.set(index, error);
      else await new Promise((done) => setTimeout(done, wait));
    }
    if (!isWanted()) return;
    this.flights.delete(index);
    this.options.came(index);
    this.wantFrom(this.from);
  }
}
