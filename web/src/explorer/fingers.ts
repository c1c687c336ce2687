/** Fingers on an element, and how they moved since they were asked for last. */
export class Fingers {
  private readonly places = new Map<number, { x: number; y: number }>();

  down(id: number, x: number, y: number): void {
    this.places.set(id, { x, y });
  }

  up(id: number): void {
    this.places.delete(id);
  }

  get count(): number {
    return this.places.size;
  }

  /** How far a finger went; of two, also by how much they parted, and about which place. */
  move(id: number, x: number, y: number): FingerMove | null {
    const before = this.places.get(id);
    if (!before) return null;
    const others = [...this.places].filter(([other]) => other !== id).map(([, place]) => place);
    this.places.set(id, { x, y });
    const share = 1 / this.places.size;
    const moved = { right: share * (x - before.x), down: share * (y - before.y) };
    if (others.length !== 1) return { ...moved, factor: 1, middle: [x, y] };
    const [other] = others;
    const apart = Math.hypot(before.x - other.x, before.y - other.y) || 1;
    const factor = Math.hypot(x - other.x, y - other.y) / apart;
    return { ...moved, factor, middle: [(x + other.x) / 2, (y + other.y) / 2] };
  }
}

export interface FingerMove {
  right: number;
  down: number;
  factor: number;
  middle: [number, number];
}
