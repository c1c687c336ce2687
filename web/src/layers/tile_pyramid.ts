/**
 * The tiles of a layer's image as the server cuts them: at level S the image is reduced by 2^S and
 * divided into squares of 512 pixels, smaller at the right and lower edge. Places are in pixels of
 * the full image, measured from its upper left corner: pixel i reaches from i to i + 1.
 */

export const tileSide = 512;

export interface PictureSize {
  readonly width: number;
  readonly height: number;
}

export interface Tile {
  readonly level: number;
  readonly column: number;
  readonly row: number;
}

export interface Rectangle {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** The level at which one tile holds the whole picture; finer levels have smaller numbers. */
export function coarsestLevel(size: PictureSize): number {
  let level = 0;
  while (Math.max(size.width, size.height) > tileSide * 2 ** level) level += 1;
  return level;
}

/**
 * The coarsest level that still has a pixel for each pixel of the screen, where `scale` is screen
 * pixels (of the device) per pixel of the full image.
 */
export function levelFor(scale: number, size: PictureSize): number {
  const level = Math.floor(Math.log2(1 / scale) + 1e-6);
  return Math.min(Math.max(level, 0), coarsestLevel(size));
}

/** What a tile covers, cut off at the picture's edge. */
export function tileRectangle(tile: Tile, size: PictureSize): Rectangle {
  const side = tileSide * 2 ** tile.level;
  return {
    left: tile.column * side,
    top: tile.row * side,
    right: Math.min((tile.column + 1) * side, size.width),
    bottom: Math.min((tile.row + 1) * side, size.height),
  };
}

/** The tiles of a level that `seen` touches, those nearest to its middle first. */
export function tilesWithin(seen: Rectangle, level: number, size: PictureSize): Tile[] {
  const side = tileSide * 2 ** level;
  const left = Math.max(seen.left, 0);
  const top = Math.max(seen.top, 0);
  const right = Math.min(seen.right, size.width);
  const bottom = Math.min(seen.bottom, size.height);
  if (left >= right || top >= bottom) return [];
  const tiles: Tile[] = [];
  for (let row = Math.floor(top / side); row * side < bottom; row += 1) {
    for (let column = Math.floor(left / side); column * side < right; column += 1) {
      tiles.push({ level, column, row });
    }
  }
  const distance = (tile: Tile) =>
    Math.hypot(
      (tile.column + 0.5) * side - (left + right) / 2,
      (tile.row + 0.5) * side - (top + bottom) / 2,
    );
  return tiles.sort((a, b) => distance(a) - distance(b));
}
