import { isAbort } from "../api/client";
import type { SectionPicture } from "./section_record";

/** What is wished for: a quick picture at once, and a sharp one when the hand rests. */
export interface Wish {
  preview: string | null; // addresses; no preview: the picture there is does until the sharp one
  sharp: string;
}

export interface SectionLoaderOptions {
  fetch: (address: string, sharp: boolean, signal: AbortSignal) => Promise<SectionPicture>;
  deliver: (picture: SectionPicture) => void;
  fail: (error: unknown) => void;
  /** Seconds to wait before asking again; null for an error that asking again does not mend. */
  retryAfter: (error: unknown) => number | null;
}

export const rest_ms = 150;
/** The server answers 20 pictures a second for as long as one likes. */
export const betweenStarts_ms = 50;
/** An older preview that takes longer than this gives way to a newer one. */
export const patience_ms = 400;

interface Flight {
  sharp: boolean;
  since: number;
  abort: AbortController;
}

/**
 * Fetches pictures of sections while the wish changes: one request at a time; of the wishes that
 * come meanwhile only the newest is kept.
 */
export class SectionLoader {
  private flight: Flight | null = null;
  private preview: string | null = null;
  private sharp: string | null = null;
  private rested = false;
  private lastStart = -Infinity;
  private restTimer: ReturnType<typeof setTimeout> | undefined;
  private startTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly options: SectionLoaderOptions) {}

  wish({ preview, sharp }: Wish): void {
    this.preview = preview;
    this.sharp = sharp;
    this.rested = false;
    clearTimeout(this.restTimer);
    this.restTimer = setTimeout(() => {
      this.rested = true;
      this.next();
    }, rest_ms);
    if (this.flight && (this.flight.sharp || this.tookTooLong(this.flight))) {
      this.flight.abort.abort();
      this.flight = null;
    }
    this.next();
  }

  stop(): void {
    clearTimeout(this.restTimer);
    clearTimeout(this.startTimer);
    this.flight?.abort.abort();
    this.flight = null;
    this.preview = null;
    this.sharp = null;
  }

  private tookTooLong(flight: Flight): boolean {
    return performance.now() - flight.since > patience_ms;
  }

  private next(): void {
    if (this.flight) return;
    const sharp = this.preview === null;
    const address = this.preview ?? (this.rested ? this.sharp : null);
    if (address === null) return;
    clearTimeout(this.startTimer);
    const wait = this.lastStart + betweenStarts_ms - performance.now();
    if (wait > 0) {
      this.startTimer = setTimeout(() => this.next(), wait);
      return;
    }
    if (sharp) this.sharp = null;
    else this.preview = null;
    this.lastStart = performance.now();
    void this.fly(address, sharp);
  }

  private async fly(address: string, sharp: boolean): Promise<void> {
    const flight = { sharp, since: performance.now(), abort: new AbortController() };
    this.flight = flight;
    try {
      const picture = await this.options.fetch(address, sharp, flight.abort.signal);
      if (this.flight !== flight) return;
      this.options.deliver(picture);
    } catch (error) {
      if (this.flight !== flight || isAbort(error)) return;
      const seconds = this.options.retryAfter(error);
      if (seconds === null) {
        this.options.fail(error);
        if (!sharp) this.sharp = null; // the same wish would fail the same way
      } else {
        if (sharp) this.sharp ??= address;
        else this.preview ??= address;
        this.lastStart = performance.now() + seconds * 1000;
      }
    }
    this.flight = null;
    this.next();
  }
}
