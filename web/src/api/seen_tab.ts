import { computed, signal } from "@preact/signals";

/** What the tabs of one browser say to each other. */
type Word =
  | "seen" // somebody looks at me
  | "gone" // I was seen last, and am being closed
  | "mine"; // I take the place of one that is gone

/** As much of a BroadcastChannel as is used. */
export interface TabChannel {
  postMessage(word: Word): void;
  onmessage: ((message: { data: Word }) => void) | null;
}

const longestClaim_ms = 500;

/**
 * Whether this tab of the browser is to hear the server's events. A browser opens no more than six
 * connections to a server: were each tab to hold one, a sixth would wait for ever. So a tab hears
 * while somebody sees it; and of those that nobody sees, the one that was seen last, whose title and
 * sound tell of an alarm.
 */
export class SeenTab {
  private readonly seen = signal(false);
  private readonly last = signal(false);
  private claim: ReturnType<typeof setTimeout> | undefined;

  /** False: the stream is other tabs'. */
  readonly hears = computed(() => this.seen.value || this.last.value);

  /** Without a channel nothing is known of other tabs, and this one always hears. */
  constructor(
    private readonly channel: TabChannel | null,
    private readonly random = Math.random,
  ) {
    if (channel) channel.onmessage = ({ data }) => this.heard(data);
    else this.last.value = true;
  }

  /** Somebody sees it, or nobody does any more. */
  show(seen: boolean): void {
    this.seen.value = seen;
    if (seen) this.take("seen");
  }

  /** It is being closed. */
  leave(): void {
    if (!this.channel || !this.last.value) return;
    this.last.value = false;
    this.channel.postMessage("gone");
  }

  private take(word: Word): void {
    clearTimeout(this.claim);
    this.last.value = true;
    this.channel?.postMessage(word);
  }

  private heard(word: Word): void {
    clearTimeout(this.claim);
    if (word !== "gone") {
      this.last.value = false;
      return;
    }
    // The others hear of it too: whoever speaks first has it.
    this.claim = setTimeout(() => this.take("mine"), this.random() * longestClaim_ms);
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
  window.addEventListener("pagehide", () => tab.leave());
  return tab;
}
