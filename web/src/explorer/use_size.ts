import { useSignal } from "@preact/signals";
import type { ReadonlySignal } from "@preact/signals";
import type { RefObject } from "preact";
import { useEffect } from "preact/hooks";

/** Of an element, in CSS pixels, and how many pixels of the screen each of them has. */
export interface ElementSize {
  width: number;
  height: number;
  ratio: number;
}

export function useSize(element: RefObject<HTMLElement>): ReadonlySignal<ElementSize> {
  const size = useSignal<ElementSize>({ width: 0, height: 0, ratio: 1 });
  useEffect(() => {
    if (!element.current) return;
    const measured = element.current;
    const measure = () => {
      const { clientWidth: width, clientHeight: height } = measured;
      const ratio = window.devicePixelRatio || 1;
      const before = size.peek();
      if (before.width === width && before.height === height && before.ratio === ratio) return;
      size.value = { width, height, ratio };
    };
    const observer = new ResizeObserver(measure);
    observer.observe(measured);
    window.addEventListener("resize", measure); // a page that is zoomed changes the ratio
    measure();
    return () => {
      observer.disconnect();
      window.removeEventListener("resize", measure);
    };
  }, []);
  return size;
}
