// The views of the page, each as it is when there is something to see.

/** Their addresses, and what is there once they are ready. */
export const views = [
  { name: "run", hash: "#/run", ready: 'main[data-view="run"] [data-chart]' },
  { name: "layers", hash: "#/layers/4", ready: 'canvas[data-role="layer"][data-state="sharp"]' },
  {
    name: "explorer",
    hash: "#/explorer",
    ready: 'canvas[data-role="section"][data-state="sharp"]',
  },
];

export async function open(tab, url, { hash, ready }) {
  await tab.visit(url, hash);
  await tab.page.locator(ready).first().waitFor();
}
