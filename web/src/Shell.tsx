import { useEffect } from "preact/hooks";

import { connection, service } from "./api/live";
import { RunView } from "./run/RunView";
import { AlarmBar } from "./shell/AlarmBar";
import { AlarmLine } from "./shell/AlarmLine";
import { CommandDialog } from "./shell/CommandDialog";
import { Connecting } from "./shell/Connecting";
import { ConnectionBanner } from "./shell/ConnectionBanner";
import { Header } from "./shell/Header";
import { LazyView } from "./shell/LazyView";
import { replaceHash, route } from "./shell/route";
import { useTabSign } from "./shell/tab_sign";
import { TokenDialog } from "./shell/TokenDialog";
import { DialogNotice } from "./ui/Dialog";

const layers = () => import("./layers/LayersView").then((module) => module.LayersView);
const explorer = () => import("./explorer/ExplorerView").then((module) => module.ExplorerView);

/** What is around every view, and the view that the address names. */
export function Shell() {
  useTabSign();
  return (
    <DialogNotice.Provider value={<AlarmLine />}>
      <a class="skip" href="#main" onClick={skipToMain}>
        Skip to the content
      </a>
      <Header />
      <div class="bars">
        <ConnectionBanner />
        <AlarmBar />
      </div>
      <CurrentView />
      <CommandDialog />
      <TokenDialog />
    </DialogNotice.Provider>
  );
}

/** The address is the view's, so that the link must not change it. */
function skipToMain(event: Event): void {
  event.preventDefault();
  document.getElementById("main")?.focus();
}

function CurrentView() {
  const name = route.value.path[0];
  const kind = service.value?.kind;
  const known = name === "layers" || name === "explorer" || (name === "run" && kind !== "view");

  useEffect(() => {
    if (!known && kind) replaceHash(kind === "view" ? "#/explorer" : "#/run");
  }, [known, kind]);

  if (kind && name === "layers") return <LazyView load={layers} />;
  if (kind && name === "explorer") return <LazyView load={explorer} />;
  if (kind === "rig" && name === "run") return <RunView />;
  return (
    <main id="main" class="view" tabIndex={-1}>
      <p class="muted">
        {connection.value.state === "lost" ? "The server does not answer." : <Connecting />}
      </p>
    </main>
  );
}
