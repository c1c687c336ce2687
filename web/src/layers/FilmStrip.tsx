import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

import { fixed } from "../ui/numbers";
import type { LayerMark, LayerMarks } from "./layer_marks";
import type { LayerFilter, LayerSequence } from "./layer_sequence";
import { useThumbnails, type Thumbnails } from "./thumbnails";
import { itemsInSight, length, scrollToCentre, scrollToShow } from "./virtual_list";

interface Props {
  sequence: LayerSequence;
  filter: LayerFilter;
  /** Layers 1 to this one have an image. */
  committed: number;
  marks: LayerMarks;
  chosen: number | null;
  onChoose: (layer: number) => void;
  /** How many pixels of the strip are in sight, when that changes. */
  onExtent: (extent: number) => void;
}

/** Width of a frame of the film and of the gap to the next; layers.css has the same. */
export const stripPitch = 124;
const spareItems = 4;
const keptThumbnails = 500;
/** Twice the width that they are shown at: sharp on a dense screen. */
const thumbnailWidth = 240;
/** A strip that is scrolled on within this time is not worth fetching for. */
const restMs = 90;

const thumbnailAddress = (layer: number) => `/api/v1/layers/${layer}/image?width=${thumbnailWidth}`;
const itemId = (layer: number) => `film-${layer}`;

/** Every layer as a frame of a film. Only frames in sight exist, and only theirs are fetched. */
export function FilmStrip(props: Props) {
  const { sequence, chosen } = props;
  const scroller = useRef<HTMLDivElement>(null);
  const [scroll, setScroll] = useState(0);
  const [extent, setExtent] = useState(0);
  const thumbnails = useThumbnails(keptThumbnails);
  const list = { count: sequence.count, pitch: stripPitch };
  const { first, end } = itemsInSight(list, scroll, extent, spareItems);
  const layers = Array.from({ length: end - first }, (_, index) => sequence.at(first + index));

  useLayoutEffect(() => {
    const element = scroller.current;
    if (!element) return;
    const observer = new ResizeObserver(() => {
      setExtent(element.clientWidth);
      props.onExtent(element.clientWidth);
    });
    observer.observe(element);
    const turn = (event: WheelEvent) => {
      if (Math.abs(event.deltaY) <= Math.abs(event.deltaX)) return;
      const before = element.scrollLeft;
      element.scrollLeft += event.deltaY;
      if (element.scrollLeft !== before) event.preventDefault();
    };
    element.addEventListener("wheel", turn, { passive: false });
    return () => {
      observer.disconnect();
      element.removeEventListener("wheel", turn);
    };
  }, []);

  // Not when layers are added: who looks at another part of the film stays there.
  useLayoutEffect(() => {
    const element = scroller.current;
    if (!element || chosen === null || extent === 0 || list.count === 0) return;
    const index = sequence.nearest(chosen);
    const shown = scrollToShow(list, index, element.scrollLeft, extent);
    const near = Math.abs(shown - element.scrollLeft) < extent;
    element.scrollLeft = near ? shown : scrollToCentre(list, index, extent);
  }, [chosen, props.filter, extent, sequence.count === 0]);

  useEffect(() => {
    const wait = setTimeout(() => {
      const there = layers.filter((layer) => layer <= props.committed);
      thumbnails.want(fromTheMiddle(there).map(thumbnailAddress));
    }, restMs);
    return () => clearTimeout(wait);
  }, [first, end, sequence, props.committed]);

  const shownChosen = chosen !== null && layers.includes(chosen);
  return (
    <div
      ref={scroller}
      class="film"
      data-role="strip"
      role="listbox"
      aria-label="Layers"
      aria-orientation="horizontal"
      aria-activedescendant={shownChosen ? itemId(chosen) : undefined}
      tabIndex={0}
      onScroll={(event) => setScroll(event.currentTarget.scrollLeft)}
    >
      <div class="film-length" role="presentation" style={{ width: `${length(list)}px` }}>
        {sequence.count === 0 && <p class="film-none muted">None</p>}
        {layers.map((layer, index) => (
          <FilmFrame
            key={layer}
            layer={layer}
            index={first + index}
            count={sequence.count}
            there={layer <= props.committed}
            chosen={layer === chosen}
            mark={props.marks.byLayer.get(layer)}
            thumbnails={thumbnails}
            onChoose={props.onChoose}
          />
        ))}
      </div>
    </div>
  );
}

interface FrameProps {
  layer: number;
  index: number;
  count: number;
  there: boolean;
  chosen: boolean;
  mark: LayerMark | undefined;
  thumbnails: Thumbnails;
  onChoose: (layer: number) => void;
}

function FilmFrame(props: FrameProps) {
  const { layer, mark, there } = props;
  void props.thumbnails.version.value;
  const address = thumbnailAddress(layer);
  const url = there ? props.thumbnails.url(address) : undefined;
  return (
    <div
      id={itemId(layer)}
      class="film-frame"
      data-layer={layer}
      data-verdict={markVerdict(mark, there)}
      role="option"
      aria-selected={props.chosen}
      aria-setsize={props.count}
      aria-posinset={props.index + 1}
      aria-label={frameWords(layer, mark, there)}
      style={{ transform: `translateX(${props.index * stripPitch}px)` }}
      onClick={() => props.onChoose(layer)}
    >
      <span class="film-picture">
        {url && <img src={url} alt="" draggable={false} />}
        {!there && <span class="film-note">not accepted yet</span>}
        {there && props.thumbnails.failed(address) && <span class="film-note">no picture</span>}
      </span>
      <span class="film-caption" aria-hidden="true">
        <span class="film-number">{fixed(layer)}</span>
        {mark?.flagged && <span class="film-flag">⚑</span>}
        {mark && mark.rejected > 0 && <span class="film-rejected">✕ {mark.rejected}</span>}
      </span>
    </div>
  );
}

/** The mark that weighs most; none of a layer that was never judged. */
function markVerdict(mark: LayerMark | undefined, there: boolean): string | undefined {
  if (mark && mark.rejected > 0) return "rejected";
  if (mark?.flagged) return "flagged";
  return there ? "accepted" : undefined;
}

function frameWords(layer: number, mark: LayerMark | undefined, there: boolean): string {
  const words = [`Layer ${layer}`];
  if (!there) words.push("not accepted yet");
  if (mark?.flagged) words.push("accepted with a flag");
  if (mark?.rejected === 1) words.push("1 rejected attempt");
  else if (mark && mark.rejected > 1) words.push(`${mark.rejected} rejected attempts`);
  return words.join(", ");
}

function fromTheMiddle(layers: readonly number[]): number[] {
  const middle = (layers.length - 1) / 2;
  return layers
    .map((layer, index) => ({ layer, distance: Math.abs(index - middle) }))
    .sort((a, b) => a.distance - b.distance)
    .map(({ layer }) => layer);
}
