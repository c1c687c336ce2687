import { signal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";

import { getBlob } from "../api/client";
import { PictureLoader } from "./picture_loader";

/**
 * Small pictures as addresses for <img>. They are fetched like everything else, so that the token
 * travels with the request, and kept as blobs.
 */
export class Thumbnails {
  /** Rises when a picture came. */
  readonly version = signal(0);
  private readonly loader: PictureLoader<string>;

  constructor(kept: number) {
    this.loader = new PictureLoader<string>(
      {
        fetch: async (address, signal) => URL.createObjectURL(await getBlob(address, signal)),
        dispose: (url) => URL.revokeObjectURL(url),
        changed: () => {
          this.version.value += 1;
        },
      },
      { kept, atOnce: 6 },
    );
  }

  want(addresses: readonly string[]): void {
    this.loader.want(addresses);
  }

  url(address: string): string | undefined {
    return this.loader.picture(address);
  }

  failed(address: string): boolean {
    return this.loader.failure(address) !== undefined;
  }

  close(): void {
    this.loader.close();
  }
}

/** Thumbnails that live as long as the component. */
export function useThumbnails(kept: number): Thumbnails {
  const [thumbnails] = useState(() => new Thumbnails(kept));
  useEffect(() => () => thumbnails.close(), []);
  return thumbnails;
}
