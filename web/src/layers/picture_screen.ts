import { effect, signal, type Signal } from "@preact/signals";

import { paintMinimap, paintPicture, type Overlay } from "./picture_painter";
import { bitmapLoader, type PictureSource } from "./picture_source";
import {
  fitted,
  held,
  isAllInSight,
  isFitted,
  seen,
  toPicture,
  toScreen,
  type Frame,
  type Point,
  type Shape,
  type Viewport,
} from "./viewport";

export interface ShownPicture {
  readonly source: PictureSource;
  readonly shape: Shape;
  readonly overlay: Overlay | null;
  /** What will probably be looked at next: fetched when all else is there. */
  readonly ahead: readonly string[];
}

/** What is on the screen at the moment. */
export interface Shown {
  readonly view: Viewport;
  readonly frame: Frame;
  /** Pixels of the device per CSS pixel. */
  readonly ratio: number;
  /** Pixels of the full picture per pixel of what is kept of it. */
  readonly reduced: number;
}

/**
 * A canvas that shows a picture as a viewport says, which it may share with other canvases; where
 * the viewport is null, all of it. Nothing is painted but when something changed.
 */
export class PictureScreen {
  readonly shown = signal<Shown | null>(null);
  /** Why some of the picture is missing; empty while it is not. */
  readonly trouble = signal("");

  private picture: ShownPicture | null = null;
  private frame: Frame = { width: 0, height: 0 };
  private pixels = { width: 0, height: 0 };
  private nextPaint = 0;
  private readonly loader = bitmapLoader(() => this.paintSoon());
  private readonly observer: ResizeObserver;
  private readonly unfollow: () => void;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly viewport: Signal<Viewport | null>,
    /** What its data-state says when all that can be seen is there. */
    private readonly complete: "sharp" | "shown",
  ) {
    this.observer = new ResizeObserver(([entry]) => this.resized(entry));
    try {
      this.observer.observe(canvas, { box: "device-pixel-content-box" });
    } catch {
      this.observer.observe(canvas); // a browser that does not tell in pixels of the device
    }
    this.unfollow = effect(() => {
      void viewport.value;
      this.paintSoon();
    });
  }

  show(picture: ShownPicture | null): void {
    if (picture?.source !== this.picture?.source) this.canvas.dataset.state = "loading";
    this.picture = picture;
    this.paintSoon();
  }

  close(): void {
    this.unfollow();
    this.observer.disconnect();
    cancelAnimationFrame(this.nextPaint);
    this.loader.close();
  }

  /** Changes the view by a function of what is seen now. */
  change(next: (view: Viewport, shape: Shape, frame: Frame, ratio: number) => Viewport): void {
    const shape = this.picture?.shape;
    const now = this.now();
    if (!shape || !now) return;
    const view = next(now.view, shape, now.frame, now.ratio);
    this.viewport.value = isFitted(view, shape, now.frame) ? null : view;
  }

  /** The place in the picture under a place in the frame. */
  placeAt(at: Point): Point | null {
    const now = this.shown.peek();
    return now && this.picture && toPicture(at, now.view, this.picture.shape, now.frame);
  }

  /** Where in the frame a place in the picture is. */
  screenAt(place: Point): Point | null {
    const now = this.shown.value;
    return now && this.picture && toScreen(place, now.view, this.picture.shape, now.frame);
  }

  allInSight(): boolean {
    const now = this.now();
    return now !== null && isAllInSight(now.view, this.picture!.shape, now.frame);
  }

  private now(): Omit<Shown, "reduced"> | null {
    if (!this.picture || this.frame.width === 0 || this.frame.height === 0) return null;
    const { shape } = this.picture;
    const ratio = this.pixels.width / this.frame.width;
    const asked = this.viewport.peek();
    const view = asked ? held(asked, shape, this.frame, ratio) : fitted(shape, this.frame);
    return { view, frame: this.frame, ratio };
  }

  private resized(entry: ResizeObserverEntry): void {
    const { width, height } = entry.contentRect;
    this.frame = { width, height };
    this.pixels = pixelsOf(entry);
    cancelAnimationFrame(this.nextPaint);
    this.paint(); // at once: a canvas that was given another size is empty
  }

  private paintSoon(): void {
    cancelAnimationFrame(this.nextPaint);
    this.nextPaint = requestAnimationFrame(() => this.paint());
  }

  private paint(): void {
    const { canvas, pixels, picture } = this;
    if (canvas.width !== pixels.width) canvas.width = pixels.width;
    if (canvas.height !== pixels.height) canvas.height = pixels.height;
    const context = canvas.getContext("2d");
    const now = this.now();
    if (!context) return;
    if (!picture || !now) {
      context.clearRect(0, 0, canvas.width, canvas.height);
      this.loader.want([]);
      return;
    }
    const { source, shape } = picture;
    const sight = seen(now.view, shape, now.frame);
    const scale = now.view.scale * now.ratio;
    const needed = source.addresses(sight, scale);
    this.loader.want([...needed, ...picture.ahead]);
    const screen = { context, ...pixels, ratio: now.ratio };
    paintPicture(
      screen,
      now.view,
      shape,
      source.pieces(sight, scale, this.loader),
      picture.overlay,
    );
    const allInSight = isAllInSight(now.view, shape, now.frame);
    const whole = source.whole(this.loader);
    if (whole && !allInSight) paintMinimap(screen, shape, sight, whole);

    const missing = needed.filter((address) => !this.loader.picture(address));
    const failure = missing.map((address) => this.loader.failure(address)).find(Boolean);
    canvas.dataset.state = failure ? "failed" : missing.length > 0 ? "loading" : this.complete;
    canvas.style.touchAction = allInSight ? "pan-y" : "none";
    this.trouble.value = failure?.message ?? "";
    this.shown.value = { ...now, reduced: source.reduction(this.loader) };
  }
}

/** The canvas's size in pixels of the device, as exactly as the browser tells it. */
function pixelsOf(entry: ResizeObserverEntry): { width: number; height: number } {
  const width = entry.contentRect.width * devicePixelRatio;
  const height = entry.contentRect.height * devicePixelRatio;
  const exact = entry.devicePixelContentBoxSize?.[0];
  // Where a browser plays another device, the exact size may be the real device's.
  if (exact && Math.abs(exact.inlineSize - width) < 2 && Math.abs(exact.blockSize - height) < 2) {
    return { width: exact.inlineSize, height: exact.blockSize };
  }
  return { width: Math.round(width), height: Math.round(height) };
}
