import { getBlob } from "../api/client";
import { PictureLoader } from "./picture_loader";
import {
  coarsestLevel,
  levelFor,
  tileRectangle,
  tilesWithin,
  type PictureSize,
  type Rectangle,
  type Tile,
} from "./tile_pyramid";

/** A piece of a picture, and what it covers in pixels of the full picture. */
export interface Piece {
  readonly bitmap: ImageBitmap;
  readonly covers: Rectangle;
  /** Pixels of the full picture per pixel of the piece. */
  readonly reduced: number;
}

/** Where a picture comes from: in tiles, or whole. */
export interface PictureSource {
  readonly size: PictureSize;
  /** What has to be fetched to see `seen` at a scale, the most urgent first. */
  addresses(seen: Rectangle, scale: number): string[];
  /** What is there of it, in the order in which it is painted: the coarse below the fine. */
  pieces(seen: Rectangle, scale: number, loader: BitmapLoader): Piece[];
  /** The whole picture, small, if it is there. */
  whole(loader: BitmapLoader): Piece | null;
  /** Pixels of the full picture per pixel of a small copy; 1 where more is kept, or nothing is here. */
  reduction(loader: BitmapLoader): number;
}

export type BitmapLoader = PictureLoader<ImageBitmap>;

/** Tiles of 512 pixels are 1 MiB each; a screen of 4K shows some 60. */
const bitmapsKept = 160;

/** Loads pictures for a canvas. `changed` is called when one came. */
export function bitmapLoader(changed: () => void): BitmapLoader {
  return new PictureLoader<ImageBitmap>(
    {
      fetch: async (address, signal) => createImageBitmap(await getBlob(address, signal)),
      dispose: (bitmap) => bitmap.close(),
      changed,
    },
    { kept: bitmapsKept, atOnce: 6 },
  );
}

/** The accepted image of a layer. */
export class TiledLayer implements PictureSource {
  constructor(
    readonly layer: number,
    readonly size: PictureSize,
  ) {}

  /** The one tile that holds the whole picture, small. */
  coarsest(): string {
    return this.address({ level: coarsestLevel(this.size), column: 0, row: 0 });
  }

  addresses(seen: Rectangle, scale: number): string[] {
    const level = levelFor(scale, this.size);
    return [
      ...new Set([
        this.coarsest(),
        ...tilesWithin(seen, level, this.size).map((tile) => this.address(tile)),
      ]),
    ];
  }

  pieces(seen: Rectangle, scale: number, loader: BitmapLoader): Piece[] {
    const finest = levelFor(scale, this.size);
    const layers: Piece[][] = [];
    for (let level = finest; level <= coarsestLevel(this.size); level += 1) {
      const tiles = tilesWithin(seen, level, this.size);
      const pieces = tiles.flatMap((tile) => this.piece(tile, loader));
      layers.unshift(pieces);
      if (pieces.length === tiles.length) break; // nothing below would be seen
    }
    return layers.flat();
  }

  whole(loader: BitmapLoader): Piece | null {
    const tile = { level: coarsestLevel(this.size), column: 0, row: 0 };
    return this.piece(tile, loader)[0] ?? null;
  }

  reduction(): number {
    return 1;
  }

  private piece(tile: Tile, loader: BitmapLoader): Piece[] {
    const bitmap = loader.picture(this.address(tile));
    if (!bitmap) return [];
    const reduced = 2 ** tile.level;
    const { left, top } = tileRectangle(tile, this.size);
    const covers = {
      left,
      top,
      right: left + bitmap.width * reduced,
      bottom: top + bitmap.height * reduced,
    };
    return [{ bitmap, covers, reduced }];
  }

  private address({ level, column, row }: Tile): string {
    return `/api/v1/layers/${this.layer}/tiles/${level}/${column}/${row}`;
  }
}

/** A frame that is kept as one small picture; it stands for a face of the full size. */
export class WholePicture implements PictureSource {
  constructor(
    readonly address: string,
    readonly size: PictureSize,
  ) {}

  addresses(): string[] {
    return [this.address];
  }

  pieces(_seen: Rectangle, _scale: number, loader: BitmapLoader): Piece[] {
    const whole = this.whole(loader);
    return whole ? [whole] : [];
  }

  whole(loader: BitmapLoader): Piece | null {
    const bitmap = loader.picture(this.address);
    if (!bitmap) return null;
    const { width, height } = this.size;
    const covers = { left: 0, top: 0, right: width, bottom: height };
    return { bitmap, covers, reduced: width / bitmap.width };
  }

  reduction(loader: BitmapLoader): number {
    return this.whole(loader)?.reduced ?? 1;
  }
}
