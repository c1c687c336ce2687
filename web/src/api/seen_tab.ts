import { batch, computed, signal } from "@preact/signals";

/** That a tab was seen last: when, and which. */
interface Claim {
  readonly at_ms: number;
  readonly tab: number;
}

/** What the tabs of one browser say to each other. */
interface Word {
  readonly claim: Claim;
  /** Its tab is being closed. */
  readonly isOver: boolean;
  /** Somebody sees its tab still. */
  readonly isSeen: boolean;
}

/** As much of a BroadcastChannel as is used. */
export interface TabChannel {
  postMessage(word: Word): void;
  onmessage: ((message: { data: Word }) => void) | null;
}

const longestWait_ms = 500;
// A tab that crashed says nothing. One that nobody sees is woken once a minute by some browsers.
const sign_ms = 60_000;
const longestSilence_ms = 4 * sign_ms;
const mostStreams = 4; // of the six connections: commands and pictures need the others

/** Of two claims that cross, every tab takes the same for the later one. */
const isLater = (claim: Claim, other: Claim | null) =>
  !other || claim.at_ms > other.at_ms || (claim.at_ms === other.at_ms && claim.tab > other.tab);

/**
 * Whether this tab of the browser is to hear the server's events. A browser opens no more than six
 * connections to a server: were each tab to hold one, a sixth would wait for ever. So a tab hears
 * while somebody sees it; and of those that nobody sees, the one that was seen last, whose title and
 * sound tell of an alarm. Of many windows that are seen side by side all but the last hear in turns.
 */
export class SeenTab {
  private readonly seen = signal(false);
  private readonly own = signal<Claim | null>(null);
  /** Tabs that are seen, and were seen later than this one: when each was heard of. */
  private readonly later = signal<ReadonlyMap<number, number>>(new Map());
  private readonly latest = signal<Claim | null>(null);
  private wait: ReturnType<typeof setTimeout> | undefined;
  private heard_ms = Date.now();

  /** False: the stream is other tabs'. */
  readonly hears = computed(() => !this.channel || this.seen.value || this.isLast());

  /** True where it must give its stream back between two looks at what is new. */
  readonly inTurns = computed(() => {
    const latest = this.latest.value;
    const before = new Set(this.later.value.keys());
    if (latest && isLater(latest, this.own.value)) before.add(latest.tab);
    return this.hears.value && before.size >= mostStreams;
  });

  /** Without a channel nothing is known of other tabs, and this one always hears. */
  constructor(
    private readonly channel: TabChannel | null,
    private readonly random = Math.random,
    private readonly name = Math.random(),
  ) {
    if (!channel) return;
    channel.onmessage = ({ data }) => this.heard(data);
    setInterval(() => this.giveSign(), sign_ms);
  }

  /** Somebody sees it, or nobody does any more. */
  show(seen: boolean): void {
    this.seen.value = seen;
    if (seen) this.take();
    else this.say();
  }

  /** It is being closed. */
  leave(): void {
    if (this.isLast()) this.latest.value = null;
    this.say(true);
    this.own.value = null;
  }

  private isLast(): boolean {
    return this.latest.value?.tab === this.name;
  }

  private giveSign(): void {
    this.forgetSilent();
    if (this.isLast() || this.seen.value) this.say();
    if (!this.isLast() && Date.now() - this.heard_ms > longestSilence_ms) this.take();
  }

  private forgetSilent(): void {
    const since_ms = Date.now() - longestSilence_ms;
    this.later.value = new Map([...this.later.value].filter(([, heard_ms]) => heard_ms > since_ms));
  }

  private say(isOver = false): void {
    const claim = this.own.value;
    const isSeen = this.seen.value;
    if (claim) this.channel?.postMessage({ claim, isOver, isSeen });
  }

  private take(): void {
    clearTimeout(this.wait);
    const before_ms = this.latest.value?.at_ms ?? 0;
    // Clocks are set back, too.
    const claim = { at_ms: Math.max(Date.now(), before_ms + 1), tab: this.name };
    batch(() => {
      this.latest.value = claim;
      this.own.value = claim;
      this.later.value = new Map(); // there are none
    });
    this.say();
  }

  private heard(word: Word): void {
    batch(() => {
      this.note(word);
      this.follow(word);
    });
  }

  /** Whether its tab goes before this one. */
  private note({ claim, isOver, isSeen }: Word): void {
    const later = new Map(this.later.value);
    if (isSeen && !isOver && isLater(claim, this.own.value)) later.set(claim.tab, Date.now());
    else later.delete(claim.tab);
    this.later.value = later;
  }

  /** Who was seen last. */
  private follow({ claim, isOver }: Word): void {
    if (!isLater(this.latest.value ?? claim, claim)) this.heard_ms = Date.now();
    if (!isOver) {
      clearTimeout(this.wait);
      if (isLater(claim, this.latest.value)) this.latest.value = claim;
    } else if (!isLater(this.latest.value ?? claim, claim)) {
      this.latest.value = null;
      // The others hear of it too: whoever speaks first has it.
      this.wait = setTimeout(() => this.take(), this.random() * longestWait_ms);
    }
  }
}

/** Of this tab, as long as the page is. */
export function thisTab(): SeenTab {
  const isKnown = "BroadcastChannel" in window;
  const tab = new SeenTab(isKnown ? (new BroadcastChannel("biotomy-tabs") as TabChannel) : null);
  const look = () => tab.show(document.visibilityState === "visible");
  look();
  document.addEventListener("visibilitychange", look);
  window.addEventListener("pageshow", look);
  window.addEventListener("focus", look); // of windows side by side it is looked at
  window.addEventListener("pagehide", () => tab.leave());
  return tab;
}
