import { effect, signal, untracked } from "@preact/signals";

import { ConnectionError, getJson, sentenceOf, servicePath } from "./client";
import type { StreamEvent } from "./event_parser";
import { EventStream } from "./events";
import { type SeenTab, thisTab } from "./seen_tab";
import { StreamTurns } from "./stream_turns";
import { askAgain, setNeeds } from "./token";
import type { Attempt, ExportJob, SampleProgress, Service, Status } from "./types";

/** What the server tells without being asked, as it stands now. Each view reads it from here. */

export const service = signal<Service | null>(null);
export const status = signal<Status | null>(null);
export const sampleProgress = signal<SampleProgress | null>(null);

export interface Connection {
  state: "connecting" | "live" | "lost" | "resting"; // resting: given up, as nobody looks
  why: string; // it is lost
  since: number; // Date.now() when it came to this state
  heardAt: number; // Date.now() when the server was last heard of; 0 if never
  retryAt: number; // Date.now() when it is tried again; 0 unless it is lost
}
export const connection = signal<Connection>({
  state: "connecting",
  why: "",
  since: Date.now(),
  heardAt: 0,
  retryAt: 0,
});

/** Functions to call with what comes; each subscription returns what ends it. */
class Listeners<T> {
  private readonly all = new Set<(value: T) => void>();

  readonly subscribe = (listener: (value: T) => void): (() => void) => {
    this.all.add(listener);
    return () => void this.all.delete(listener);
  };

  tell(value: T): void {
    for (const listener of [...this.all]) listener(value);
  }
}

const attempts = new Listeners<Attempt>();
const exports = new Listeners<ExportJob>();
const gaps = new Listeners<void>();

/** Each attempt once, in order, those missed while the connection was lost included. */
export const onAttempt = attempts.subscribe;
export const onExport = exports.subscribe;
/** So much was missed that what was fetched before must be fetched anew. */
export const onGap = gaps.subscribe;

/** Hands an event on to those that it is for; what can't be read is left out. */
export function takeEvent(event: StreamEvent): void {
  let value: unknown;
  try {
    value = JSON.parse(event.data);
  } catch {
    return;
  }
  switch (event.name) {
    case "status":
      status.value = value as Status;
      break;
    case "attempt":
      attempts.tell(value as Attempt);
      break;
    case "sample":
      takeProgress(value as SampleProgress);
      break;
    case "export":
      exports.tell(value as ExportJob);
      break;
    case "reload":
      gaps.tell();
      break;
  }
}

/** When the sample was begun of which something may be shown. */
let begunAt: string | null = null;

/** Another sample may have the same name: what is shown is not of that one. */
function takeProgress(progress: SampleProgress): void {
  const { created } = progress;
  if (created && begunAt && created !== begunAt) {
    location.reload();
    return;
  }
  begunAt = created ?? begunAt;
  sampleProgress.value = progress;
}

const changed = (state: Connection["state"], why = "", retryAt = 0): void => {
  const since = connection.value.state === state ? connection.value.since : Date.now();
  connection.value = { state, why, since, heardAt: stream.heardAt, retryAt };
};

const stream = new EventStream("/api/v1/events", {
  event: takeEvent,
  live() {
    // The server may be another one than before: its version, its sample.
    if (connection.value.state !== "connecting" || !service.value) void learnService();
    changed("live");
    turns.opened();
  },
  lost(why, retry_ms) {
    changed("lost", why, Date.now() + retry_ms);
  },
});

const turns = new StreamTurns(stream);

const isSame = (one: Service, other: Service): boolean =>
  one.version === other.version && one.kind === other.kind && one.sample === other.sample;

async function learnService(): Promise<void> {
  try {
    const learnt = await getJson<Service>(servicePath);
    if (service.value && !isSame(service.value, learnt)) {
      location.reload(); // the page belongs to the server, and what it shows to the sample
      return;
    }
    setNeeds({ reading: learnt.reading === "token", commands: learnt.commands_need_token });
    service.value = learnt;
  } catch (error) {
    const { state } = connection.value;
    if (state === "live") askAgainLater();
    else if (state !== "resting") changed("lost", sentenceOf(error));
  }
}

const serviceAgain_ms = 3000;
let serviceAgain: number | undefined;

/** A server that tells its news may still be too busy to say what it is. */
function askAgainLater(): void {
  clearTimeout(serviceAgain);
  serviceAgain = window.setTimeout(() => void learnService(), serviceAgain_ms);
}

const patience_ms = 1000;
let patience: number | undefined;

/** Whoever looks again sees what was known: it is old unless the server answers soon. */
function hear(inTurns: boolean): void {
  if (connection.value.state === "resting") {
    patience = window.setTimeout(() => {
      if (connection.value.state === "resting") changed("lost", new ConnectionError().message);
    }, patience_ms);
  }
  if (inTurns) turns.begin();
  else {
    turns.end();
    stream.open();
  }
}

function rest(): void {
  clearTimeout(patience);
  turns.end();
  stream.close();
  changed("resting");
}

/** Begins to listen, and goes on until the page is closed. */
export function goLive(tab: SeenTab = thisTab()): void {
  // What the server is decides whether to ask for a token before anything else.
  void learnService().then(() =>
    effect(() => {
      const hears = tab.hears.value;
      const inTurns = tab.inTurns.value;
      untracked(() => (hears ? hear(inTurns) : rest()));
    }),
  );
  window.addEventListener("online", () => stream.hurry());
  document.addEventListener("visibilitychange", () => {
    if (document.visibilityState === "visible") stream.hurry();
  });
}

/** Tries to connect now, as somebody asked for it. */
export function reconnect(): void {
  askAgain();
  stream.hurry();
}
