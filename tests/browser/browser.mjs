// Debian's Chromium, and pages of it that write down what they should not say.
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

const executablePath = process.env.BIOTOMY_CHROMIUM;

const quietly = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

export const screen = { width: 1440, height: 900 };
/** A context's options. */
export const phone = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };

const patience = 60_000; // ms: a machine that is busy is not a page that is wrong

export function launch(more = []) {
  return chromium.launch({ executablePath, args: [...quietly, ...more] });
}

/** A page of its own, with its own memory, and all that went over its network and console. */
export class Tab {
  faults = []; // console errors, exceptions, requests that failed, what the policy forbade
  requests = []; // { url, headers, type }
  answers = []; // { url, status }

  static async open(browser, options = {}) {
    const tab = new Tab();
    tab.context = await browser.newContext({
      viewport: screen,
      reducedMotion: "reduce",
      acceptDownloads: true,
      ...options,
    });
    tab.context.setDefaultTimeout(patience);
    await tab.context.addInitScript(() => {
      addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI }) => {
        console.error(`security policy: ${violatedDirective} ${blockedURI}`);
      });
    });
    tab.page = await tab.context.newPage();
    tab.#watch();
    return tab;
  }

  #watch() {
    this.page.on("console", (message) => {
      if (message.type() !== "error") return;
      this.faults.push(`console: ${message.text()} (${message.location().url})`);
    });
    this.page.on("pageerror", (error) => this.faults.push(`exception: ${error.stack ?? error}`));
    this.page.on("request", (request) => {
      const { url, headers, type } = {
        url: request.url(),
        headers: request.headers(),
        type: request.resourceType(),
      };
      this.requests.push({ url, headers, type, method: request.method() });
    });
    this.page.on("requestfailed", (request) => {
      const why = request.failure()?.errorText ?? "";
      // A picture that nobody waits for any more is given up by the page itself.
      if (why === "net::ERR_ABORTED") return;
      this.faults.push(`request: ${request.method()} ${request.url()} ${why}`);
    });
    this.page.on("response", (response) => {
      this.answers.push({ url: response.url(), status: response.status() });
    });
  }

  /** Goes to a view of the page, such as "#/run", and waits until it is there and is told the news. */
  async visit(url, hash) {
    await this.page.goto(`${url}/${hash}`);
    await this.page.locator("main[data-view]").waitFor();
    await this.isLive();
  }

  isLive() {
    return this.page.locator('body[data-connection="live"]').waitFor();
  }

  /** Fails if anything was said, failed or was forbidden. `expected`: what the test has provoked. */
  assertNoFaults(expected = []) {
    const faults = this.faults.filter((fault) => !expected.some((words) => words.test(fault)));
    assert.deepEqual(faults, []);
  }

  /** Fails if a request went anywhere but to `url`, or carried `secret` in its address. */
  assertKeptTo(url, secret) {
    const foreign = this.requests.filter(
      (request) =>
        !["data:", "blob:"].includes(new URL(request.url).protocol) &&
        new URL(request.url).origin !== url,
    );
    assert.deepEqual(foreign, []);
    if (secret) {
      const told = this.requests.filter((request) => request.url.includes(secret));
      assert.deepEqual(
        told.map(({ url: address }) => address),
        [],
      );
    }
  }

  async close() {
    await this.context?.close();
  }
}
