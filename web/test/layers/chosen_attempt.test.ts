import { expect, it } from "vitest";

import type { LayerDetail } from "../../src/api/types";
import { chosenAttempt } from "../../src/layers/chosen_attempt";

const detail = (...verdicts: string[]) =>
  ({ attempts: verdicts.map((verdict, i) => ({ attempt: i + 1, verdict })) }) as LayerDetail;

const several = detail("rejected", "accepted", "rejected", "not_stored");

it.each([
  ["the one that the link names", several, 3, false, 3],
  ["the accepted one", several, null, false, 2],
  ["the last that gave no layer, where those are looked for", several, null, true, 4],
  ["the last, where none was accepted", detail("rejected", "rejected"), null, false, 2],
  ["the accepted one, where the link's is not there", several, 9, false, 2],
  ["none of a layer that was never judged", detail(), 1, false, undefined],
  ["none before anything is known", null, 1, true, undefined],
])("it is %s", (_, of, named, rejectedFirst, attempt) => {
  expect(chosenAttempt(of, named, rejectedFirst)?.attempt).toBe(attempt);
});
