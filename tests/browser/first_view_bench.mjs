// Prints how long the first view takes on this computer: each time in a tab that knows nothing yet.
// usage: cmake --build --preset release --target first_view_bench
import { Tab, launch } from "./browser.mjs";
import { loadFirstView } from "./first_view.mjs";
import { Rig } from "./rig.mjs";

const times = 10;

const rig = await Rig.start({ layers: 4 });
const browser = await launch();
try {
  await rig.runJob();
  const seconds = [];
  let size = "";
  for (let i = 0; i < times; ++i) {
    const tab = await Tab.open(browser);
    const seen = await loadFirstView(tab, rig.url);
    seconds.push(seen.seconds);
    size = `${(seen.bytes / 1024).toFixed(1)} KiB in ${seen.files.length} files`;
    await tab.close();
  }
  seconds.sort((a, b) => a - b);
  const told = (value) => `${value.toFixed(2)} s`;
  console.log(
    `first view: ${size}; of ${times}: fastest ${told(seconds[0])}, median ${told(seconds[times >> 1])}, slowest ${told(seconds[times - 1])}`,
  );
} finally {
  await browser.close();
  await rig.stop();
}
