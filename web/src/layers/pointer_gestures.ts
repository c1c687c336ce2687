/** What fingers and the mouse do on a picture: drag, pinch, double tap, swipe. */

import type { Point } from "./viewport";

export interface PointerPlace extends Point {
  readonly id: number;
  readonly timeMs: number;
}

export interface GestureListener {
  dragged(by: Point): void;
  /** Two fingers moved apart by `factor` about `at`, and together by `by`. */
  pinched(factor: number, at: Point, by: Point): void;
  doubleTapped(at: Point): void;
  /** One finger went quickly to the left (−1) or the right (1). */
  swiped(direction: -1 | 1): void;
}

const tapReach = 8;
const doubleTapReach = 24;
const doubleTapMs = 350;
const swipeReach = 50;
const swipeMs = 600;

interface Held {
  readonly start: PointerPlace;
  now: PointerPlace;
}

export class PointerGestures {
  private readonly held = new Map<number, Held>();
  private lastTap: PointerPlace | null = null;
  /** More than one finger was down since the first came. */
  private several = false;

  constructor(private readonly listener: GestureListener) {}

  down(place: PointerPlace): void {
    if (this.held.size === 0) this.several = false;
    this.held.set(place.id, { start: place, now: place });
    if (this.held.size > 1) this.several = true;
  }

  move(place: PointerPlace): void {
    const finger = this.held.get(place.id);
    if (finger === undefined) return;
    const before = this.spread();
    const was = finger.now;
    finger.now = place;
    if (this.held.size === 1) {
      this.listener.dragged({ x: place.x - was.x, y: place.y - was.y });
    } else if (this.held.size === 2) {
      const after = this.spread();
      const factor = before.distance > 0 ? after.distance / before.distance : 1;
      const by = { x: after.middle.x - before.middle.x, y: after.middle.y - before.middle.y };
      this.listener.pinched(factor, after.middle, by);
    }
  }

  up(place: PointerPlace): void {
    const finger = this.held.get(place.id);
    this.held.delete(place.id);
    if (finger === undefined || this.several) return;
    const x = place.x - finger.start.x;
    const y = place.y - finger.start.y;
    if (Math.hypot(x, y) <= tapReach) this.tapped(place);
    else if (place.timeMs - finger.start.timeMs <= swipeMs && Math.abs(x) >= swipeReach) {
      if (Math.abs(x) > 2 * Math.abs(y)) this.listener.swiped(x < 0 ? -1 : 1);
    }
  }

  /** The browser took the pointer for something of its own. */
  cancel(id: number): void {
    this.held.delete(id);
  }

  private tapped(place: PointerPlace): void {
    const last = this.lastTap;
    const near = last !== null && Math.hypot(place.x - last.x, place.y - last.y) <= doubleTapReach;
    if (near && place.timeMs - last.timeMs <= doubleTapMs) {
      this.lastTap = null;
      this.listener.doubleTapped(place);
    } else {
      this.lastTap = place;
    }
  }

  private spread(): { distance: number; middle: Point } {
    const [a, b] = [...this.held.values()].map((finger) => finger.now);
    if (a === undefined || b === undefined) return { distance: 0, middle: a ?? { x: 0, y: 0 } };
    return {
      distance: Math.hypot(a.x - b.x, a.y - b.y),
      middle: { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 },
    };
  }
}
