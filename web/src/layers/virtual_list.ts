/**
 * A list of items of one size of which only those in sight exist. All lengths are CSS pixels along
 * the list; item i reaches from i · pitch to (i + 1) · pitch.
 */

export interface List {
  readonly count: number;
  readonly pitch: number;
}

export interface Range {
  readonly first: number;
  /** One past the last. */
  readonly end: number;
}

/** The items that a window of `extent` at `scroll` touches, and `spare` more on each side. */
export function itemsInSight(list: List, scroll: number, extent: number, spare = 0): Range {
  const first = Math.max(Math.floor(scroll / list.pitch) - spare, 0);
  const end = Math.min(Math.ceil((scroll + extent) / list.pitch) + spare, list.count);
  return first < end ? { first, end } : { first: 0, end: 0 };
}

export function length(list: List): number {
  return list.count * list.pitch;
}

/** The scroll nearest to `scroll` at which item `index` is wholly in sight. */
export function scrollToShow(list: List, index: number, scroll: number, extent: number): number {
  const start = index * list.pitch;
  const latest = Math.max(start + list.pitch - extent, 0);
  return heldScroll(list, Math.max(Math.min(scroll, start), latest), extent);
}

/** The scroll at which item `index` is in the middle, as far as the list's ends allow. */
export function scrollToCentre(list: List, index: number, extent: number): number {
  return heldScroll(list, (index + 0.5) * list.pitch - extent / 2, extent);
}

function heldScroll(list: List, scroll: number, extent: number): number {
  return Math.min(Math.max(scroll, 0), Math.max(length(list) - extent, 0));
}

/** Items that one press of Page Down passes: what is in sight, less one to keep one's place. */
export function itemsOfPage(list: List, extent: number): number {
  return Math.max(Math.floor(extent / list.pitch) - 1, 1);
}
