import type { ExplorerState } from "./explorer_state";
import type { Vector3 } from "./geometry/vector3";

/** A place of the screen, in CSS pixels. */
export type Place = readonly [number, number];

/** How near to an edge a press means it, CSS pixels. */
const reach = { mouse: 8, touch: 16 };

/** The edge nearest to a place, of those no farther than `limit`; edge i begins at vertex i. */
export function nearestEdge(
  vertices: readonly Place[],
  place: Place,
  limit: number,
): number | null {
  const distances = vertices.map((from, edge) =>
    distanceToSegment(place, from, vertices[(edge + 1) % vertices.length]),
  );
  const least = Math.min(...distances);
  return least <= limit ? distances.indexOf(least) : null;
}

function distanceToSegment([x, y]: Place, [ax, ay]: Place, [bx, by]: Place): number {
  const [right, down] = [bx - ax, by - ay];
  const squared = right * right + down * down;
  const part = squared === 0 ? 0 : ((x - ax) * right + (y - ay) * down) / squared;
  const held = Math.min(1, Math.max(0, part));
  return Math.hypot(x - ax - held * right, y - ay - held * down);
}

/** The edge of the section polygon under the pointer; none while a series plays. */
export function edgeUnder(
  state: ExplorerState,
  toScreen: (point: Vector3) => Place,
  place: Place,
  pointerType: string,
): number | null {
  const polygon = state.placed.value?.polygon ?? [];
  if (state.frame.value || polygon.length < 3) return null;
  return nearestEdge(
    polygon.map(toScreen),
    place,
    reach[pointerType === "mouse" ? "mouse" : "touch"],
  );
}

/** The largest rectangle on that edge becomes the picture. */
export function chooseEdge(state: ExplorerState, edge: number): void {
  const { theta } = state.choices.value;
  if (theta.kind === "edge" && theta.edge === edge) return;
  state.choose({ theta: { kind: "edge", edge } });
}
