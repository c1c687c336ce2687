import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { sampleProgress } from "../api/live";
import type { Attempt } from "../api/types";
import { goTo, replaceHash, route } from "../shell/route";
import { fixed } from "../ui/numbers";
import { AttemptsPanel } from "./AttemptsPanel";
import { bringIntoSight } from "./bring_into_sight";
import { chosenAttempt } from "./chosen_attempt";
import { FilmStrip, stripPitch } from "./FilmStrip";
import { useLayerDetail } from "./layer_detail";
import { layerHash, layerLink } from "./layer_link";
import type { LayerFilter } from "./layer_sequence";
import { LayerPanel } from "./LayerPanel";
import "./layers.css";
import { LayerStage } from "./LayerStage";
import {
  begun,
  committed,
  filter,
  highest,
  historyTrouble,
  judged,
  marks,
  sample,
  sampleTrouble,
  sequence,
  watchLayers,
} from "./layers_state";
import type { PictureScreen } from "./picture_screen";
import type { MapKind } from "./sharpness_overlay";
import { StripTools } from "./StripTools";
import { useLayerKeys } from "./use_layer_keys";
import { useViewLink } from "./view_link";
import type { Viewport } from "./viewport";
import { itemsOfPage } from "./virtual_list";

// They stay as they are while another view is looked at.
const viewport = signal<Viewport | null>(null);
const mapShown = signal(false);
const mapKind = signal<MapKind>("own");
const mapOpacity = signal(0.6);

/** The layers as a film, one of them large, and what was found out about it. */
export function LayersView() {
  useEffect(watchLayers, []);
  const known = sample.value;
  const pixel = known && { x: known.spacing_um[0], y: known.spacing_um[1] };
  useViewLink(viewport, pixel);

  return (
    <main id="main" class="view layers" data-view="layers" tabIndex={-1}>
      <h1 class="visually-hidden">Layers</h1>
      {known && highest.value > 0 ? <Layers /> : <NoLayers />}
    </main>
  );
}

function NoLayers() {
  const knows = sampleProgress.value !== null;
  const waits =
    knows && !begun.value ? "No layer has been photographed yet." : "Looking for layers…";
  return (
    <div class="layers-none">
      <p>{begun.value && sampleTrouble.value ? sampleTrouble.value : waits}</p>
    </div>
  );
}

function Layers() {
  const link = layerLink(route.value);
  const newest = committed.value || highest.value;
  const layer = link.layer ?? newest;
  const exists = layer <= highest.value;
  const answer = useLayerDetail(exists ? layer : null);
  const chosen = chosenAttempt(answer.value, link.attempt, filter.value === "rejected");
  const screen = useRef<PictureScreen | null>(null);
  const stripExtent = useRef(0);
  const panes = useRef<HTMLDivElement>(null);
  const known = sample.value;

  const choose = (number: number) =>
    replaceHash(layerHash({ layer: number, attempt: null }, route.peek().query));
  const chooseAt = (index: number) => {
    const { count } = sequence.value;
    if (count > 0) choose(sequence.value.at(Math.min(Math.max(index, 0), count - 1)));
  };
  const step = (by: number) => chooseAt(sequence.value.nearest(layer) + by);
  const filterBy = (next: LayerFilter) => {
    filter.value = next;
    const { count, nearest, at } = sequence.value;
    const shown = count > 0 ? at(nearest(layer)) : layer;
    if (shown !== layer) choose(shown);
  };
  const showPanes = () => panes.current && bringIntoSight(panes.current);
  const chooseAttempt = (attempt: Attempt) => {
    replaceHash(layerHash({ layer, attempt: attempt.attempt }, route.peek().query));
    showPanes();
  };

  // On a phone what was chosen is shown a screen or two above.
  const arrivedAt = useRef(link);
  useEffect(() => {
    const { layer, attempt } = arrivedAt.current;
    arrivedAt.current = link;
    if (layer !== link.layer || attempt !== link.attempt) showPanes();
  }, [link.layer, link.attempt]);

  useLayerKeys({
    step,
    page: (by) =>
      step(
        by * itemsOfPage({ count: sequence.value.count, pitch: stripPitch }, stripExtent.current),
      ),
    first: () => chooseAt(0),
    last: () => chooseAt(sequence.value.count - 1),
    whole: () => (viewport.value = null),
    screen: () => screen.current,
  });

  if (!known) return null;
  const neighbours = [layer + 1, layer - 1].filter(
    (other) => other >= 1 && other <= committed.value,
  );
  return (
    <>
      {exists ? (
        <LayerStage
          panes={panes}
          layer={layer}
          there={layer <= committed.value}
          neighbours={neighbours}
          sample={known}
          detail={answer.value}
          chosen={chosen}
          viewport={viewport}
          map={mapShown}
          mapKind={mapKind}
          opacity={mapOpacity}
          screen={screen}
          onTurn={step}
        />
      ) : (
        <div class="stage">
          <p class="notice">
            There is no layer {fixed(layer)} yet: the last is {fixed(highest.value)}.
          </p>
        </div>
      )}
      <div class="layer-strip">
        {historyTrouble.value && (
          <p class="notice notice-bad">What was judged is not known: {historyTrouble.value}</p>
        )}
        <StripTools
          filter={filter.value}
          onFilter={filterBy}
          judged={judged.value}
          count={sequence.value.count}
          committed={committed.value}
          highest={highest.value}
          following={link.layer === null}
          onFollow={(following) =>
            goTo(layerHash({ layer: following ? null : layer, attempt: null }, route.peek().query))
          }
          onJump={choose}
          onStep={step}
        />
        <FilmStrip
          sequence={sequence.value}
          filter={filter.value}
          committed={committed.value}
          marks={marks.value}
          chosen={exists ? layer : null}
          onChoose={choose}
          onExtent={(extent) => (stripExtent.current = extent)}
        />
      </div>
      <LayerPanel>
        {exists && (
          <AttemptsPanel
            layer={layer}
            thicknessUm={known.spacing_um[2]}
            detail={answer.value}
            trouble={answer.trouble}
            chosen={chosen}
            onChoose={chooseAttempt}
          />
        )}
      </LayerPanel>
    </>
  );
}
