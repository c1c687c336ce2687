import { useSignal, type Signal } from "@preact/signals";
import type { RefObject } from "preact";
import { useMemo, useRef } from "preact/hooks";

import type { Attempt, LayerDetail, Sample } from "../api/types";
import { Button } from "../ui/Button";
import { micrometres, percent, significant } from "../ui/numbers";
import { PicturePane } from "./PicturePane";
import { zoomBy, zoomStep, zoomToPixels } from "./picture_controls";
import type { PictureScreen } from "./picture_screen";
import { TiledLayer, WholePicture } from "./picture_source";
import { depthText, placeDecimals, toSample, type PixelSize } from "./sample_place";
import { tileAt } from "./sharpness_map";
import { useShownMap, type MapKind, type ShownMap } from "./sharpness_overlay";
import { SharpnessTools } from "./SharpnessTools";
import { slugWords, verdictWords } from "../journal/verdict_words";
import type { Point, Viewport } from "./viewport";

interface Props {
  panes: RefObject<HTMLDivElement>;
  layer: number;
  /** The layer has an image. */
  there: boolean;
  /** Its neighbours have one too: they will be wanted next. */
  neighbours: readonly number[];
  sample: Sample;
  detail: LayerDetail | null;
  chosen: Attempt | null;
  viewport: Signal<Viewport | null>;
  map: Signal<boolean>;
  mapKind: Signal<MapKind>;
  opacity: Signal<number>;
  /** Where keys act on. */
  screen: { current: PictureScreen | null };
  onTurn: (direction: -1 | 1) => void;
}

/** The layer's image, large; beside it a frame that was not taken for it, if one is chosen. */
export function LayerStage(props: Props) {
  const { layer, there, sample, chosen, viewport } = props;
  const cursor = useSignal<Point | null>(null);
  const sharpness = useShownMap(props.map.value && there ? layer : null, props.mapKind.value);
  const pixel = { x: sample.spacing_um[0], y: sample.spacing_um[1] };
  const shape = useMemo(
    () => ({ width: sample.size[0], height: sample.size[1], stretch: pixel.y / pixel.x }),
    [sample.size[0], sample.size[1], pixel.x, pixel.y],
  );
  const ahead = props.neighbours.map((other) => new TiledLayer(other, shape).coarsest()).join(" ");
  const { shown } = sharpness;
  const accepted = useMemo(
    () => ({
      source: new TiledLayer(layer, shape),
      shape,
      overlay: shown?.range
        ? { map: shown.map, range: shown.range, opacity: props.opacity.value }
        : null,
      ahead: ahead === "" ? [] : ahead.split(" "),
    }),
    [layer, shape, shown?.map, shown?.range, props.opacity.value, ahead],
  );
  const other = chosen && verdictWords(chosen.verdict).accepted ? null : chosen;
  const image = other?.image ?? null;
  const compared = useMemo(
    () =>
      image === null
        ? null
        : { source: new WholePicture(image, shape), shape, overlay: null, ahead: [] },
    [image, shape],
  );
  const screens = useRef<{ accepted: PictureScreen | null; compared: PictureScreen | null }>({
    accepted: null,
    compared: null,
  });
  const keep = (name: "accepted" | "compared") => (screen: PictureScreen | null) => {
    screens.current[name] = screen;
    props.screen.current = screens.current.accepted ?? screens.current.compared;
  };
  const shared = { layer, pixel, viewport, cursor, cross: other !== null, onTurn: props.onTurn };

  return (
    <div class="stage">
      <div class="stage-panes" ref={props.panes} data-panes={there && other ? 2 : 1}>
        {there && (
          <PicturePane
            key="accepted"
            {...shared}
            label={`Layer ${layer}, the accepted image`}
            role="layer"
            picture={accepted}
            onScreen={keep("accepted")}
          >
            {other && <p class="pane-title pane-title-good">{acceptedTitle(props.detail)}</p>}
          </PicturePane>
        )}
        {other && compared && (
          <PicturePane
            key="compared"
            {...shared}
            label={`Layer ${layer}, attempt ${other.attempt}, rejected`}
            role="attempt-image"
            attempt={other.attempt}
            picture={compared}
            onScreen={keep("compared")}
          >
            <p class="pane-title pane-title-bad">{otherTitle(other)}</p>
          </PicturePane>
        )}
        {other && !compared && (
          <div
            class="pane pane-empty"
            data-role="attempt-image"
            data-attempt={other.attempt}
            data-state="none"
          >
            <p class="pane-title pane-title-bad">{otherTitle(other)}</p>
            <p>The picture of this attempt was not kept.</p>
          </div>
        )}
        {!there && !other && (
          <div class="pane pane-empty">
            <p>This layer has no accepted image yet.</p>
          </div>
        )}
        <CursorPlace
          cursor={cursor}
          pixel={pixel}
          depth={depthText(layer, sample.spacing_um[2])}
          map={shown}
        />
      </div>
      <div class="stage-tools">
        <div class="stage-zoom" role="group" aria-label="Zoom">
          <ZoomButton of={props.screen} label="Smaller" factor={1 / zoomStep}>
            −
          </ZoomButton>
          <ZoomButton of={props.screen} label="Larger" factor={zoomStep}>
            +
          </ZoomButton>
          <Button onClick={() => (viewport.value = null)}>Whole</Button>
          <Button onClick={() => props.screen.current && zoomToPixels(props.screen.current)}>
            1:1
          </Button>
        </div>
        {there && (
          <SharpnessTools
            shown={props.map.value}
            onShow={(shown) => (props.map.value = shown)}
            kind={props.mapKind.value}
            onKind={(kind) => (props.mapKind.value = kind)}
            opacity={props.opacity.value}
            onOpacity={(opacity) => (props.opacity.value = opacity)}
            answer={sharpness}
          />
        )}
      </div>
    </div>
  );
}

function acceptedTitle(detail: LayerDetail | null): string {
  const attempt = detail?.attempts.find(({ verdict }) => verdictWords(verdict).accepted);
  return attempt
    ? `${verdictWords(attempt.verdict).title}: attempt ${attempt.attempt}`
    : "Accepted";
}

function otherTitle(attempt: Attempt): string {
  const { title } = verdictWords(attempt.verdict);
  return `${title}: attempt ${attempt.attempt}, ${slugWords(attempt.slug)}`;
}

interface ZoomButtonProps {
  of: Props["screen"];
  label: string;
  factor: number;
  children: string;
}

function ZoomButton({ of, label, factor, children }: ZoomButtonProps) {
  return (
    <Button aria-label={label} onClick={() => of.current && zoomBy(of.current, factor)}>
      {children}
    </Button>
  );
}

interface PlaceProps {
  cursor: Signal<Point | null>;
  pixel: PixelSize;
  depth: string;
  map: ShownMap | null;
}

/** Where in the sample the cursor is, and how sharp it is there. */
function CursorPlace({ cursor, pixel, depth, map }: PlaceProps) {
  const place = cursor.value;
  if (!place) return null;
  const um = toSample(place, pixel);
  const decimals = placeDecimals(pixel);
  const words = [
    `x ${micrometres(um.x, decimals)}`,
    `y ${micrometres(um.y, decimals)}`,
    `z ${depth}`,
  ];
  if (map) words.push(sharpnessWords(map, place));
  return <p class="stage-place">{words.join("  ")}</p>;
}

function sharpnessWords({ map, kind }: ShownMap, place: Point): string {
  const tile = tileAt(map, place);
  const value = tile === null ? null : map.values[tile];
  if (value === null) return "too little detail";
  return kind === "own"
    ? `sharpness ${significant(value)}`
    : `${percent(value * 100)} of the layer before`;
}
