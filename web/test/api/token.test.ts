// @vitest-environment happy-dom
import { beforeEach, describe, expect, it } from "vitest";

import {
  askAgain,
  askForToken,
  needsToken,
  setNeeds,
  setToken,
  token,
  tokenQuestion,
} from "../../src/api/token";

describe("the token", () => {
  beforeEach(() => {
    setToken("");
    askAgain();
    setNeeds({ reading: false, commands: false });
  });

  it("is kept for this tab alone", () => {
    setToken("secret");
    expect(token()).toBe("secret");
    expect(sessionStorage.length).toBe(1);
    expect(localStorage.length).toBe(0);
    setToken("");
    expect(sessionStorage.length).toBe(0);
  });

  it("is not asked for again by the page itself once a person declined", async () => {
    const first = askForToken("why");
    tokenQuestion.value?.answer(null);
    expect(await first).toBeNull();
    expect(await askForToken("why")).toBeNull();
    expect(tokenQuestion.value).toBeNull();

    const command = askForToken("why", true);
    expect(tokenQuestion.value).not.toBeNull();
    tokenQuestion.value?.answer("secret");
    expect(await command).toBe("secret");
  });

  it("is asked for again when a person asks to connect", async () => {
    const first = askForToken("why");
    tokenQuestion.value?.answer(null);
    await first;
    askAgain();
    void askForToken("why");
    expect(tokenQuestion.value).not.toBeNull();
    tokenQuestion.value?.answer(null);
  });

  it("is needed as far as the server says so, and only while there is none", () => {
    expect(needsToken(true)).toBe(false);
    setNeeds({ reading: false, commands: true });
    expect([needsToken(true), needsToken(false)]).toEqual([false, true]);
    setToken("secret");
    expect(needsToken(false)).toBe(false);
  });
});
