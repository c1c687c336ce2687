import type { ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";

import { sentenceOf } from "../api/client";
import { Button } from "../ui/Button";

interface Props {
  /** Fetches the view's program; must be the same function at each rendering. */
  load: () => Promise<ComponentType>;
}

/** A view whose program is fetched when it is first looked at. */
export function LazyView({ load }: Props) {
  const [view, setView] = useState<{ of: Props["load"]; component: ComponentType } | null>(null);
  const [failure, setFailure] = useState("");

  useEffect(() => {
    let wanted = true;
    setFailure("");
    load().then(
      (component) => wanted && setView({ of: load, component }),
      (error: unknown) => wanted && setFailure(sentenceOf(error)),
    );
    return () => {
      wanted = false;
    };
  }, [load]);

  if (view && view.of === load) return <view.component />;
  if (failure) {
    return (
      <p class="view-note">
        This part of the page could not be loaded: {failure}{" "}
        {/* The server may carry a newer page by now, whose files have other names. */}
        <Button onClick={() => location.reload()}>Load the page again</Button>
      </p>
    );
  }
  return <p class="view-note">Loading…</p>;
}
