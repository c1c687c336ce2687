// What the browser fetches for the first view, and how long it takes.

/** Opens the run's view in a tab that knows nothing yet: {files: [{url, bytes}], bytes, seconds}. Bytes
 * are as they came over the network, headers included; the stream of events does not end. */
export async function loadFirstView(tab, url) {
  const session = await tab.context.newCDPSession(tab.page);
  await session.send("Network.enable");
  const files = new Map();
  session.on("Network.requestWillBeSent", ({ requestId, request }) =>
    files.set(requestId, { url: request.url, bytes: 0 }),
  );
  session.on("Network.loadingFinished", ({ requestId, encodedDataLength }) => {
    const file = files.get(requestId);
    if (file) file.bytes = encodedDataLength;
  });
  const begin = performance.now();
  await tab.page.goto(`${url}/#/run`);
  await tab.page.locator('main[data-view="run"] h1').waitFor();
  await tab.page.locator("header [data-state]").waitFor();
  const seconds = (performance.now() - begin) / 1000;
  await tab.isLive();
  const seen = [...files.values()].filter((file) => !file.url.startsWith("data:"));
  return { files: seen, bytes: seen.reduce((sum, file) => sum + file.bytes, 0), seconds };
}
