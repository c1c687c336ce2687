import { signal } from "@preact/signals";

/**
 * The bearer token. It is kept as long as the tab is, and goes nowhere but into the header
 * `Authorization`.
 */

const key = "biotomy-token";

function stored(): string {
  try {
    return sessionStorage.getItem(key) ?? "";
  } catch {
    return ""; // storage may be forbidden; then it lives as long as the page
  }
}

const held = signal(stored());

export const token = (): string => held.value;

/** For what the server wants a token. What is not known to need one is asked without. */
let needs = { reading: false, commands: false };

export const needsToken = (isReading: boolean): boolean =>
  (isReading ? needs.reading : needs.commands) && token() === "";

export function setNeeds(known: { reading: boolean; commands: boolean }): void {
  needs = known;
}

/** Why a token is asked for, and what is called with the answer; null when none is. */
export interface TokenQuestion {
  why: string;
  answer(token: string | null): void;
}
export const tokenQuestion = signal<TokenQuestion | null>(null);

export function setToken(value: string): void {
  held.value = value;
  try {
    if (value) sessionStorage.setItem(key, value);
    else sessionStorage.removeItem(key);
  } catch {
    // As above.
  }
}

let asking: Promise<string | null> | null = null;
let declined = false;

/**
 * Asks the person for a token, once however many ask for it; null when they would rather not. Who
 * declined is not asked again before `askAgain()`, or by somebody who must (`insist`): what was asked
 * for by nobody but the page itself is no reason to keep asking.
 */
export function askForToken(why: string, insist = false): Promise<string | null> {
  if (declined && !insist) return Promise.resolve(null);
  asking ??= new Promise<string | null>((resolve) => {
    tokenQuestion.value = {
      why,
      answer(value) {
        tokenQuestion.value = null;
        asking = null;
        declined = !value;
        if (value) setToken(value);
        resolve(value);
      },
    };
  });
  return asking;
}

export function askAgain(): void {
  declined = false;
}
