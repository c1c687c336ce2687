import { service } from "../api/live";
import { linkOf } from "../shell/explorer_link";
import { Button } from "../ui/Button";
import { CopyButton } from "./CopyButton";
import type { ExplorerState } from "./explorer_state";
import type { ExportJobs } from "./export_jobs";
import { ExportButton } from "./ExportButton";
import { neuroglancerLink } from "./neuroglancer";
import { fetchOutline } from "./section_fetch";
import type { SectionTools } from "./section_tools";
import { noZoom, toFullResolution, zoomAbout } from "./section_zoom";
import { viewQuery } from "./view_hash";

interface Props {
  state: ExplorerState;
  tools: SectionTools;
  exports: ExportJobs;
  onExport: () => void;
}

/** What can be done with the section that is shown. */
export function SectionToolbar({ state, tools, exports, onExport }: Props) {
  const measuring = tools.tool.value === "measure";
  const inSeries = state.frame.value !== null;
  return (
    <div class="section-toolbar" role="toolbar" aria-label="Section">
      <div class="tool-group">
        <Button
          aria-pressed={!state.closeup.value}
          onClick={() => (state.closeup.value = null)}
          title="Show all of it"
        >
          All
        </Button>
        <Button
          aria-label="Smaller"
          disabled={inSeries}
          title={inSeries ? noZoom : undefined}
          onClick={() => zoomAbout(state, 1 / 1.5)}
        >
          −
        </Button>
        <Button
          aria-label="Larger"
          disabled={inSeries}
          title={inSeries ? noZoom : undefined}
          onClick={() => zoomAbout(state, 1.5)}
        >
          +
        </Button>
        <Button
          disabled={inSeries}
          title={inSeries ? noZoom : "One voxel, one pixel"}
          onClick={() => toFullResolution(state)}
        >
          1:1
        </Button>
        <Button aria-pressed={measuring} onClick={() => tools.take(measuring ? "look" : "measure")}>
          Measure
        </Button>
      </div>
      <div class="tool-group">
        <CopyButton what="Link to this view" text={() => linkTo(state)}>
          Copy link
        </CopyButton>
        <CopyButton what="The command that makes this picture" text={() => commandOf(state)}>
          Copy as command
        </CopyButton>
        <NeuroglancerLink state={state} />
        <ExportButton exports={exports} onClick={onExport} />
      </div>
    </div>
  );
}

const linkTo = (state: ExplorerState): string =>
  `${location.origin}${location.pathname}${linkOf(viewQuery(state.shownView.value))}`;

/** At full resolution, whatever is on the screen; of a series, of the frame that is shown. */
async function commandOf(state: ExplorerState): Promise<string> {
  const frame = state.frame.value;
  if (frame) return frame.picture.record.command;
  const query = state.query.value;
  if (!query) throw new Error("There is no section yet.");
  return (await fetchOutline({ ...query, format: "png" })).command;
}

function NeuroglancerLink({ state }: { state: ExplorerState }) {
  const words = "Open in neuroglancer";
  const base = service.value?.neuroglancer;
  const sample = state.sample.value;
  if (!base || !sample) return null;
  if (service.value?.reading === "token") {
    return (
      <Button disabled title="Reading needs a token here, and neuroglancer has none">
        {words}
      </Button>
    );
  }
  return (
    <a
      class="button button-link"
      href={neuroglancerLink(base, location.origin, sample, state.shownPlane.value)}
      target="_blank"
      rel="noopener noreferrer"
    >
      {words}
    </a>
  );
}
