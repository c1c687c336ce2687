/** Scrolls to an element of which less than half is seen, and not below the bars that stay in sight. */
export function bringIntoSight(element: HTMLElement): void {
  const covered = document.querySelector(".bars")?.getBoundingClientRect().height ?? 0;
  const { top, bottom, height } = element.getBoundingClientRect();
  const seen = Math.min(bottom, window.innerHeight) - Math.max(top, covered);
  if (seen >= height / 2) return;
  element.style.scrollMarginTop = `${covered}px`;
  element.scrollIntoView({ block: "start" });
}
