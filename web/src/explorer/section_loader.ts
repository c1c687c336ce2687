import { isAbort } from "../api/client";
import type { SectionPicture } from "./section_record";

export interface PictureRequest {
  address: string;
  of: string; // the section as it was chosen, of which this is a picture
  sharp: boolean;
  whole: boolean; // else of a part, for a close-up
}

/** What is wished for: a quick picture at once, and a sharp one when the hand rests. */
export interface Wish {
  preview: PictureRequest | null; // none: the picture there is does until the sharp one comes
  sharp: PictureRequest;
}

export interface SectionLoaderOptions {
  fetch: (asked: PictureRequest, signal: AbortSignal) => Promise<SectionPicture>;
  deliver: (picture: SectionPicture, asked: PictureRequest) => void;
  fail: (error: unknown) => void;
  /** How long to wait before asking again; null for an error that asking again does not mend. */
  busyWait_ms: (error: unknown) => number | null;
}

export const rest_ms = 150;
/** The server answers 50 pictures a second for as long as one likes: this leaves it half. */
const betweenStarts_ms = 40;
/** An older preview that takes longer than this gives way to a newer one. */
const patience_ms = 400;

interface Flight {
  asked: PictureRequest;
  since: number;
  abort: AbortController;
}

/**
 * Fetches pictures of sections while the wish changes: one request at a time; of the wishes that
 * come meanwhile only the newest is kept.
 */
export class SectionLoader {
  private flight: Flight | null = null;
  private preview: PictureRequest | null = null;
  private sharp: PictureRequest | null = null;
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
    if (this.flight && (this.flight.asked.sharp || this.tookTooLong(this.flight))) {
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
    const asked = this.preview ?? (this.rested ? this.sharp : null);
    if (asked === null) return;
    clearTimeout(this.startTimer);
    const wait = this.lastStart + betweenStarts_ms - performance.now();
    if (wait > 0) {
      this.startTimer = setTimeout(() => this.next(), wait);
      return;
    }
    if (asked.sharp) this.sharp = null;
    else this.preview = null;
    this.lastStart = performance.now();
    void this.fly(asked);
  }

  private async fly(asked: PictureRequest): Promise<void> {
    const flight = { asked, since: performance.now(), abort: new AbortController() };
    this.flight = flight;
    try {
      const picture = await this.options.fetch(asked, flight.abort.signal);
      if (this.flight !== flight) {
        picture.image.close();
        return;
      }
      this.options.deliver(picture, asked);
    } catch (error) {
      if (this.flight !== flight || isAbort(error)) return;
      const wait = this.options.busyWait_ms(error);
      if (wait === null) {
        this.options.fail(error);
        // Of the same wish the sharp picture would fail the same way.
        if (!asked.sharp && this.preview === null) this.sharp = null;
      } else {
        if (asked.sharp) this.sharp ??= asked;
        else this.preview ??= asked;
        this.lastStart = performance.now() + wait;
      }
    }
    this.flight = null;
    this.next();
  }
}
