import type { Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

import { percent, significant } from "../ui/numbers";
import { controlPicture } from "./picture_controls";
import { PictureScreen, type ShownPicture } from "./picture_screen";
import { scaleBar } from "./scale_bar";
import type { PixelSize } from "./sample_place";
import type { Point, Viewport } from "./viewport";

interface Props {
  /** What the picture shows, for who cannot see it. */
  label: string;
  role: "layer" | "attempt-image";
  layer: number;
  attempt?: number;
  picture: ShownPicture;
  pixel: PixelSize;
  viewport: Signal<Viewport | null>;
  /** Shared by all pictures of the same face. */
  cursor: Signal<Point | null>;
  /** Marks the place under the cursor, which may be in another picture. */
  cross: boolean;
  onScreen?: (screen: PictureScreen | null) => void;
  onTurn: (direction: -1 | 1) => void;
  /** What lies over the picture. */
  children?: ComponentChildren;
}

const widestBar = 130;

/** A picture to zoom and to move, with its scale. */
export function PicturePane(props: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [screen, setScreen] = useState<PictureScreen | null>(null);
  const turn = useRef(props.onTurn);
  turn.current = props.onTurn;

  useEffect(() => {
    if (!canvas.current) return;
    const made = new PictureScreen(
      canvas.current,
      props.viewport,
      props.role === "layer" ? "sharp" : "shown",
    );
    const release = controlPicture({
      canvas: canvas.current,
      screen: made,
      cursor: props.cursor,
      turned: (direction) => turn.current(direction),
    });
    setScreen(made);
    props.onScreen?.(made);
    return () => {
      release();
      made.close();
      props.onScreen?.(null);
    };
  }, []);

  // Before anybody can see the new layer's number beside the old one's picture.
  useLayoutEffect(() => screen?.show(props.picture), [screen, props.picture]);

  return (
    <div class="pane">
      <canvas
        ref={canvas}
        class="pane-canvas"
        role="img"
        aria-label={props.label}
        data-role={props.role}
        data-layer={props.layer}
        data-attempt={props.attempt}
      />
      {screen && <Scale screen={screen} pixel={props.pixel} />}
      {screen && props.cross && <Cross screen={screen} cursor={props.cursor} />}
      {screen && <Trouble screen={screen} />}
      {props.children}
    </div>
  );
}

function Scale({ screen, pixel }: { screen: PictureScreen; pixel: PixelSize }) {
  const shown = screen.shown.value;
  if (!shown) return null;
  const bar = scaleBar(pixel.x / shown.view.scale, widestBar);
  const copy = shown.reduced > 1.01 ? `small copy, 1 : ${significant(shown.reduced, 2)}` : "";
  return (
    <div class="pane-scale">
      <div class="pane-bar" style={{ width: `${bar.width}px` }} />
      <span>
        {bar.text} · {percent(shown.view.scale * shown.ratio * 100)}
        {copy && ` · ${copy}`}
      </span>
    </div>
  );
}

/** It follows the cursor without the pane being rendered anew. */
function Cross({ screen, cursor }: { screen: PictureScreen; cursor: Signal<Point | null> }) {
  const place = cursor.value;
  const at = place && screen.screenAt(place);
  if (!at) return null;
  return <div class="pane-cross" style={{ transform: `translate(${at.x}px, ${at.y}px)` }} />;
}

function Trouble({ screen }: { screen: PictureScreen }) {
  const why = screen.trouble.value;
  if (!why) return null;
  return (
    <p class="pane-trouble notice notice-bad" role="status">
      Some of the picture could not be loaded: {why}
    </p>
  );
}
