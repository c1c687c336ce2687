import { layerHash } from "../layers/layer_link";
import { fixed } from "../ui/numbers";
import { rejectedCount, rejectedOfLate } from "./run_history";

/** The last frames that were not good enough, and the way to them. */
export function RejectedList() {
  const count = rejectedCount.value;
  const shown = rejectedOfLate.value;
  return (
    <section class="rejected" aria-label="Rejected photographs">
      <h2>Rejected photographs: {fixed(count)}</h2>
      {shown.length === 0 ? (
        <p class="muted">None so far; the best one of a layer is listed when the layer is done.</p>
      ) : (
        <ol class="rejected-list">
          {shown.map(({ id, layer, attempt, reason, slug }) => (
            <li key={id}>
              <a href={layerHash({ layer, attempt })}>
                Layer {fixed(layer)}, attempt {attempt}
              </a>{" "}
              {reason || slug}
            </li>
          ))}
        </ol>
      )}
    </section>
  );
}
