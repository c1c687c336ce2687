import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { SeenTab, type TabChannel } from "../../src/api/seen_tab";

/** A browser in which each tab hears what the others say: at once, or `later_ms`. */
class Browser {
  private readonly channels: TabChannel[] = [];
  private readonly crashed = new Set<TabChannel>();
  private readonly channelOf = new Map<SeenTab, TabChannel>();

  constructor(private readonly later_ms = 0) {}

  tab(random = 0.5): SeenTab {
    const channel: TabChannel = {
      onmessage: null,
      postMessage: (data) => {
        if (this.crashed.has(channel)) return;
        const others = this.channels.filter((other) => other !== channel);
        const tell = () => others.forEach((other) => other.onmessage?.({ data }));
        if (this.later_ms > 0) setTimeout(tell, this.later_ms);
        else tell();
      },
    };
    this.channels.push(channel);
    const tab = new SeenTab(channel, () => random);
    this.channelOf.set(tab, channel);
    return tab;
  }

  /** It is never heard of again. */
  crash(tab: SeenTab): void {
    this.crashed.add(this.channelOf.get(tab)!);
  }
}

describe("of the tabs of a browser", () => {
  let browser: Browser;

  beforeEach(() => {
    vi.useFakeTimers();
    browser = new Browser();
  });
  afterEach(() => vi.useRealTimers());

  /** As the browser opens a tab before another: that one is hidden first. */
  const openAfter = (before: SeenTab, random?: number) => {
    before.show(false);
    vi.advanceTimersByTime(100);
    const tab = browser.tab(random);
    tab.show(true);
    return tab;
  };
  const hearing = (...tabs: SeenTab[]) => tabs.map(({ hears }) => hears.value);

  it("the one that is seen hears, the others give their streams back", () => {
    const first = browser.tab();
    first.show(true);
    const second = openAfter(first);
    const third = openAfter(second);
    expect(hearing(first, second, third)).toEqual([false, false, true]);
    third.show(false);
    first.show(true);
    expect(hearing(first, second, third)).toEqual([true, false, false]);
  });

  it("one that was opened unseen waits until it is seen", () => {
    const first = browser.tab();
    first.show(true);
    const behind = browser.tab();
    behind.show(false);
    expect(hearing(first, behind)).toEqual([true, false]);
  });

  it("the one that was seen last goes on to hear while none is seen", () => {
    const first = browser.tab();
    first.show(true);
    const second = openAfter(first);
    second.show(false);
    expect(hearing(first, second)).toEqual([false, true]);
  });

  it("another, and only one, takes its place when it is closed", () => {
    const first = browser.tab(0.9);
    first.show(true);
    const second = openAfter(first, 0.1);
    const third = openAfter(second);
    third.show(false);
    third.leave();
    expect(hearing(first, second, third)).toEqual([false, false, false]);
    vi.advanceTimersByTime(1000);
    expect(hearing(first, second, third)).toEqual([false, true, false]);
  });

  it("only one takes its place where all want to at once and hear of each other too late", () => {
    const slow = new Browser(200);
    const tabs = [slow.tab(), slow.tab(), slow.tab(), slow.tab()];
    const last = tabs.pop()!;
    last.show(true);
    vi.advanceTimersByTime(1000);
    last.show(false);
    last.leave();
    vi.advanceTimersByTime(600);
    expect(hearing(...tabs)).toEqual([true, true, true]);
    vi.advanceTimersByTime(1000);
    expect(hearing(...tabs).filter((hears) => hears)).toHaveLength(1);
  });

  it("one that is seen keeps what it took while the last one was being closed", () => {
    const slow = new Browser(200);
    const [first, second, third] = [slow.tab(), slow.tab(), slow.tab()];
    first.show(true);
    vi.advanceTimersByTime(1000);
    first.show(false);
    second.show(true);
    first.leave();
    second.show(false);
    vi.advanceTimersByTime(2000);
    expect(hearing(first, second, third)).toEqual([false, true, false]);
  });

  it("another, and only one, takes the place of one that crashed", () => {
    const tabs = [browser.tab(), browser.tab(), browser.tab()];
    const last = browser.tab();
    last.show(true);
    last.show(false);
    vi.advanceTimersByTime(600_000);
    expect(hearing(...tabs)).toEqual([false, false, false]);
    browser.crash(last);
    vi.advanceTimersByTime(120_000);
    expect(hearing(...tabs)).toEqual([false, false, false]);
    vi.advanceTimersByTime(240_000);
    expect(hearing(...tabs).filter((hears) => hears)).toHaveLength(1);
  });

  it("a clock that is set back changes nothing", () => {
    const [first, second] = [browser.tab(), browser.tab()];
    first.show(true);
    first.show(false);
    vi.setSystemTime(Date.now() - 3_600_000);
    second.show(true);
    second.show(false);
    expect(hearing(first, second)).toEqual([false, true]);
  });

  it("none takes the place of one that was not the last", () => {
    const first = browser.tab();
    first.show(true);
    const second = openAfter(first);
    first.leave();
    vi.advanceTimersByTime(1000);
    expect(hearing(first, second)).toEqual([false, true]);
  });

  it("two that are seen side by side both hear", () => {
    const [left, right] = [browser.tab(), browser.tab()];
    left.show(true);
    right.show(true);
    expect(hearing(left, right)).toEqual([true, true]);
    left.show(false);
    expect(hearing(left, right)).toEqual([false, true]);
  });

  it("of many that are seen side by side the four that were seen last need not take turns", () => {
    const tabs = Array.from({ length: 6 }, () => browser.tab());
    for (const tab of tabs) tab.show(true);
    expect(hearing(...tabs)).toEqual(Array(6).fill(true));
    const inTurns = () => tabs.map((tab) => tab.inTurns.value);
    expect(inTurns()).toEqual([true, true, false, false, false, false]);
    tabs[0].show(true); // it is looked at
    expect(inTurns()).toEqual([false, true, true, false, false, false]);
    tabs[4].show(false);
    expect(inTurns()).toEqual([false, true, false, false, false, false]);
    tabs[5].leave();
    expect(inTurns().slice(0, 5)).toEqual([false, false, false, false, false]);
  });

  it("one that is seen last and then hidden has its stream still, which counts", () => {
    const tabs = Array.from({ length: 5 }, () => browser.tab());
    for (const tab of tabs) tab.show(true);
    tabs[4].show(false);
    expect(tabs.map((tab) => tab.inTurns.value)).toEqual([true, false, false, false, false]);
  });

  it("those that crashed hold none for ever", () => {
    const tabs = Array.from({ length: 5 }, () => browser.tab());
    for (const tab of tabs) tab.show(true);
    browser.crash(tabs[2]);
    vi.advanceTimersByTime(180_000);
    expect(tabs[0].inTurns.value).toBe(true);
    vi.advanceTimersByTime(180_000);
    expect(tabs[0].inTurns.value).toBe(false);
  });

  it("each hears where they can't speak to each other", () => {
    const tab = new SeenTab(null);
    tab.show(false);
    tab.leave();
    expect(tab.hears.value).toBe(true);
  });
});
