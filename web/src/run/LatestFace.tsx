import { useEffect, useState } from "preact/hooks";

import { getBlob, withQuery } from "../api/client";
import { persistently } from "../api/retry_wait";
import { hashOf } from "../shell/route";
import { fixed } from "../ui/numbers";

const width_px = 640;
const usualWait_ms = 3000;

/** The photograph of the last layer that was stored. */
export function LatestFace({ layer }: { layer: number }) {
  const [face, setFace] = useState<{ layer: number; url: string } | null>(null);

  useEffect(() => {
    if (layer <= 0) return undefined;
    const given = new AbortController();
    const path = withQuery(`/api/v1/layers/${layer}/image`, { width: width_px });
    persistently((signal) => getBlob(path, signal), given.signal, usualWait_ms).then(
      (blob) => setFace({ layer, url: URL.createObjectURL(blob) }),
      // The face before it is shown, with its number; the Layers view tells what is wrong with it.
      () => undefined,
    );
    return () => given.abort();
  }, [layer]);

  useEffect(() => () => void (face && URL.revokeObjectURL(face.url)), [face]);

  if (!face) return null;
  return (
    <section class="panel latest" aria-label="Last photograph">
      <h2>
        <a href={hashOf(["layers", face.layer])}>Layer {fixed(face.layer)}</a>
      </h2>
      <img class="latest-image" src={face.url} alt={`Face of layer ${face.layer}`} />
    </section>
  );
}
