import { connection, service, status } from "../api/live";
import { fixed } from "../ui/numbers";
import { seenInExplorer } from "./explorer_link";
import { route } from "./route";
import { sampleName } from "./sample_name";
import { isStartLatch, moodOf, wordsOf } from "./state_words";

const views = [
  { name: "run", label: "Run" },
  { name: "layers", label: "Layers" },
  { name: "explorer", label: "Explorer" },
];

export function Header() {
  const here = route.value.path[0];
  const isRig = service.value?.kind !== "view";
  const sample = sampleName(status.value, service.value);
  return (
    <header class="head">
      <div class="head-name">Biotomy {sample && <span class="head-sample">· {sample}</span>}</div>
      <nav class="head-nav" aria-label="Views">
        {views
          .filter(({ name }) => isRig || name !== "run")
          .map(({ name, label }) => (
            <a
              href={name === "explorer" ? seenInExplorer.value : `#/${name}`}
              aria-current={here === name ? "page" : undefined}
            >
              {label}
            </a>
          ))}
      </nav>
      <HeaderState />
    </header>
  );
}

function HeaderState() {
  const now = status.value;
  if (!now) return null;
  const short = isStartLatch(now) ? "Just started" : wordsOf(now.state).short;
  const lost = connection.value.state === "lost";
  return (
    <div class="head-state" data-mood={lost ? "unknown" : moodOf(now)} data-state={now.state}>
      <span class="head-state-dot" aria-hidden="true" />
      <span>{lost ? `Was: ${short}` : short}</span>
      {now.layers > 0 && (
        <span class="head-layer">
          {fixed(now.committed)} of {fixed(now.layers)} layers
        </span>
      )}
    </div>
  );
}
