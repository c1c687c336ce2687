import { useSignal, useSignalEffect } from "@preact/signals";
import { useRef } from "preact/hooks";

import type { ExplorerState } from "./explorer_state";
import type { Vector3 } from "./geometry/vector3";
import { refusalWords } from "./refusal_words";
import { pressedOnSection, sectionKeys } from "./section_keys";
import type { SectionTools } from "./section_tools";
import { SectionOverlay } from "./SectionOverlay";
import { useSectionPointer } from "./use_section_pointer";
import { useSize } from "./use_size";

interface Props {
  state: ExplorerState;
  tools: SectionTools;
}

/** The section's picture, pixel for pixel of the screen where it is sharp. */
export function SectionView({ state, tools }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const size = useSize(box);

  useSignalEffect(() => {
    const { width, height, ratio } = size.value;
    state.panel.value = {
      width: Math.floor(width * ratio),
      height: Math.floor(height * ratio),
      ratio,
    };
  });

  useSignalEffect(() => {
    const picture = state.shownPicture.value;
    const element = canvas.current;
    if (!element || !picture) return;
    if (element.width !== picture.image.width) element.width = picture.image.width;
    if (element.height !== picture.image.height) element.height = picture.image.height;
    element.getContext("2d")?.drawImage(picture.image, 0, 0);
    element.dataset.command = picture.record.command_here;
  });
  useSignalEffect(() => {
    const element = canvas.current;
    if (!element) return;
    const playing = state.frame.value !== null;
    const sharp = playing ? state.frame.value?.picture.sharp : state.settled.value;
    const failed = state.failure.value !== "";
    element.dataset.state = failed ? "error" : sharp ? "sharp" : "preview";
  });
  useSignalEffect(() => {
    const element = canvas.current;
    const place = state.placement.value;
    const { ratio } = state.panel.value;
    if (!element || !place) return;
    element.style.width = `${place.width / ratio}px`;
    element.style.height = `${place.height / ratio}px`;
    element.style.transform = `translate(${place.left / ratio}px, ${place.top / ratio}px)`;
    element.classList.toggle("enlarged", place.width > element.width);
  });

  const draft = useSignal<[Vector3, Vector3] | null>(null); // a rectangle that is being drawn
  useSectionPointer(box, state, tools, draft);

  return (
    <div
      class="section-panel"
      ref={box}
      data-tool={tools.tool.value}
      data-closeup={state.closeup.value ? "" : undefined}
    >
      <canvas
        ref={canvas}
        class="section-canvas"
        data-role="section"
        data-state="preview"
        tabIndex={0}
        role="application"
        aria-label="Picture of the section"
        aria-describedby="section-keys"
        onKeyDown={(event) => pressedOnSection(event, state, tools)}
        hidden={!state.placement.value}
      />
      <p id="section-keys" hidden>
        {sectionKeys}
      </p>
      <SectionOverlay state={state} tools={tools} draft={draft} />
      {state.failure.value && (
        <p class="section-failure notice notice-warn" role="status">
          {refusalWords(state.failure.value)}
        </p>
      )}
    </div>
  );
}
