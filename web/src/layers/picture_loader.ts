import { retryWaitMs } from "../api/retry_wait";

/**
 * Fetches pictures in the order in which they are wanted, a few at a time, and keeps a bounded
 * number of them. What is no longer wanted is not fetched any further.
 */

export interface PictureLoaderParts<Picture> {
  /** Rejects with an ApiError or a ConnectionError, or with anything once `signal` is aborted. */
  fetch(address: string, signal: AbortSignal): Promise<Picture>;
  /** Gives back what the picture holds. */
  dispose(picture: Picture): void;
  /** Something came, or did not. */
  changed(): void;
}

export interface PictureLoaderLimits {
  /** Pictures kept; those that are wanted are kept whatever their number. */
  readonly kept: number;
  readonly atOnce: number;
}

const shortestWaitMs = 500;
const longestWaitMs = 8000;

export class PictureLoader<Picture> {
  private readonly pictures = new Map<string, Picture>();
  private readonly underWay = new Map<string, AbortController>();
  private readonly failures = new Map<string, Error>();
  private wanted: readonly string[] = [];
  private waitMs = 0;
  private waiting: ReturnType<typeof setTimeout> | null = null;
  private closed = false;

  constructor(
    private readonly parts: PictureLoaderParts<Picture>,
    private readonly limits: PictureLoaderLimits,
  ) {}

  /** The pictures wanted from now on, the most urgent first. */
  want(addresses: readonly string[]): void {
    if (this.closed) return;
    this.wanted = addresses;
    const still = new Set(addresses);
    for (const [address, request] of this.underWay) {
      if (!still.has(address)) {
        this.underWay.delete(address);
        request.abort();
      }
    }
    for (const address of this.failures.keys()) {
      if (!still.has(address)) this.failures.delete(address); // it is tried again when it is wanted
    }
    for (const address of addresses) this.touch(address);
    this.forgetOldest(still);
    this.startNext();
  }

  picture(address: string): Picture | undefined {
    return this.pictures.get(address);
  }

  /** Why a picture will not come by itself. */
  failure(address: string): Error | undefined {
    return this.failures.get(address);
  }

  close(): void {
    this.want([]);
    this.closed = true;
    if (this.waiting !== null) clearTimeout(this.waiting);
    for (const picture of this.pictures.values()) this.parts.dispose(picture);
    this.pictures.clear();
  }

  private startNext(): void {
    if (this.waiting !== null) return;
    for (const address of this.wanted) {
      if (this.underWay.size >= this.limits.atOnce) return;
      if (this.pictures.has(address) || this.underWay.has(address)) continue;
      if (!this.failures.has(address)) void this.load(address);
    }
  }

  private async load(address: string): Promise<void> {
    const request = new AbortController();
    this.underWay.set(address, request);
    try {
      const picture = await this.parts.fetch(address, request.signal);
      if (request.signal.aborted) {
        this.parts.dispose(picture);
        return;
      }
      this.pictures.set(address, picture);
      this.waitMs = 0;
    } catch (error) {
      if (request.signal.aborted) return;
      this.failed(address, error);
    }
    this.underWay.delete(address);
    this.forgetOldest(new Set(this.wanted));
    this.parts.changed();
    this.startNext();
  }

  private failed(address: string, error: unknown): void {
    const usual = Math.min(Math.max(this.waitMs * 2, shortestWaitMs), longestWaitMs);
    const wait = retryWaitMs(error, usual);
    if (wait === null) {
      this.failures.set(address, error instanceof Error ? error : new Error(String(error)));
      return;
    }
    this.waitMs = usual;
    this.waiting ??= setTimeout(() => {
      this.waiting = null;
      this.startNext();
    }, wait);
  }

  /** Moves a picture to the end of those that are forgotten first. */
  private touch(address: string): void {
    const picture = this.pictures.get(address);
    if (picture === undefined) return;
    this.pictures.delete(address);
    this.pictures.set(address, picture);
  }

  private forgetOldest(kept: ReadonlySet<string>): void {
    for (const [address, picture] of this.pictures) {
      if (this.pictures.size <= this.limits.kept) return;
      if (kept.has(address)) continue;
      this.pictures.delete(address);
      this.parts.dispose(picture);
    }
  }
}
