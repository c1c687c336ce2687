import { untracked, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";

import "./explorer.css";
import { CuboidView } from "./CuboidView";
import { ExplorerState } from "./explorer_state";
import { ExportDialog } from "./ExportDialog";
import { ExportJobs } from "./export_jobs";
import { defaultExport } from "./export_order";
import { PlaneControls } from "./PlaneControls";
import { PlayerBar } from "./PlayerBar";
import { SectionControls } from "./SectionControls";
import { SectionStatus } from "./SectionStatus";
import { SectionToolbar } from "./SectionToolbar";
import { SectionTools } from "./section_tools";
import { SectionView } from "./SectionView";
import { SeriesFields } from "./SeriesFields";
import { SeriesPlayer } from "./series_player";
import { useLink } from "./use_link";
import { useSample } from "./use_sample";
import { useSection } from "./use_section";

/** The block, a plane in it, and the section that the plane cuts. */
export function ExplorerView() {
  const state = useMemo(() => new ExplorerState(), []);
  const tools = useMemo(() => new SectionTools(), []);
  const player = useMemo(() => new SeriesPlayer(state), []);
  const exports = useMemo(() => new ExportJobs(), []);
  const exporting = useSignal(false);
  const exportChoice = useSignal(defaultExport);
  useLink(state);
  useSample(state);
  useSection(state);
  useEffect(() => {
    void exports.learn();
    return exports.watch();
  }, []);
  useEffect(() => () => player.close(), []);
  useSignalEffect(() => {
    // A series is of the plane it began from, drawn as it was chosen then.
    void [state.definition.value, state.choices.value];
    untracked(() => {
      player.close();
      tools.measured.value = null; // its places were on another plane
    });
  });
  useSignalEffect(() => {
    void state.frame.value; // of a series: another plane with each
    untracked(() => (tools.measured.value = null));
  });
  return (
    <main id="main" class="view explorer" data-view="explorer" tabIndex={-1}>
      <h1 class="visually-hidden">Explorer</h1>
      <CuboidView state={state} />
      <div class="section-column">
        <SectionToolbar
          state={state}
          tools={tools}
          exports={exports}
          onExport={() => (exporting.value = true)}
        />
        <SectionView state={state} tools={tools} />
        <SectionStatus state={state} tools={tools} />
        <PlayerBar player={player} />
      </div>
      <div class="explorer-controls">
        <PlaneControls state={state} />
        <SectionControls state={state} tools={tools} />
        <section class="panel explorer-panel" aria-labelledby="series-title">
          <h2 id="series-title">Series</h2>
          <SeriesFields state={state} player={player} />
        </section>
      </div>
      {exporting.value && (
        <ExportDialog
          state={state}
          player={player}
          exports={exports}
          choice={exportChoice}
          onClose={() => (exporting.value = false)}
        />
      )}
    </main>
  );
}
