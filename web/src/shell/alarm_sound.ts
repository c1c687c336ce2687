import { effect, signal } from "@preact/signals";

import { connection, status } from "../api/live";
import type { Status } from "../api/types";
import { isStartLatch } from "./state_words";

/** The sound of an alarm, where somebody asked for it. */

const key = "biotomy-sound";
const repeat_ms = 2500;

function stored(): boolean {
  try {
    return localStorage.getItem(key) === "on";
  } catch {
    return false;
  }
}

/** Asked for on this computer; remembered. */
export const soundWanted = signal(stored());
/** The browser keeps silent until somebody has touched the page. */
export const soundBlocked = signal(false);
/** The alarm that was silenced, and only that. */
export const silenced = signal("");

/** What tells one alarm from another; empty where none is to be heard. */
export function alarmKey(now: Status | null): string {
  if (!now?.alarm || isStartLatch(now)) return "";
  return `${now.alarm.since} ${now.alarm.cause}`;
}

export function wantSound(wanted: boolean): void {
  soundWanted.value = wanted;
  try {
    localStorage.setItem(key, wanted ? "on" : "off");
  } catch {
    // It is not remembered, then.
  }
  if (wanted) void play([880]);
}

export function silence(): void {
  silenced.value = alarmKey(status.value);
}

let context: AudioContext | null = null;

async function play(tones_hz: number[]): Promise<void> {
  if (!("AudioContext" in window)) return;
  context ??= new AudioContext();
  // resume() waits for a touch for ever where the browser wants one.
  void context.resume();
  await new Promise((resolve) => setTimeout(resolve, 50));
  soundBlocked.value = context.state !== "running";
  if (context.state !== "running") return;
  const length_s = 0.28;
  tones_hz.forEach((tone_hz, index) => {
    const begin = context!.currentTime + index * length_s;
    const oscillator = context!.createOscillator();
    const volume = context!.createGain();
    oscillator.type = "square";
    oscillator.frequency.value = tone_hz;
    volume.gain.setValueAtTime(0, begin);
    volume.gain.linearRampToValueAtTime(0.25, begin + 0.01);
    volume.gain.setValueAtTime(0.25, begin + length_s - 0.03);
    volume.gain.linearRampToValueAtTime(0, begin + length_s);
    oscillator.connect(volume).connect(context!.destination);
    oscillator.start(begin);
    oscillator.stop(begin + length_s);
  });
}

let repeating: number | undefined;

/** Sounds as long as there is an alarm that nobody has silenced. */
export function watchAlarms(): void {
  effect(() => {
    const alarm = alarmKey(status.value);
    // A tab that rests does not hear that an alarm is over; another one sounds it.
    const hears = connection.value.state !== "resting";
    const sounds = soundWanted.value && hears && alarm !== "" && alarm !== silenced.value;
    if (sounds && repeating === undefined) {
      const ring = () => void play([880, 660, 880]);
      repeating = window.setInterval(ring, repeat_ms);
      ring();
    } else if (!sounds && repeating !== undefined) {
      clearInterval(repeating);
      repeating = undefined;
    }
  });
  // It was switched in another tab.
  window.addEventListener("storage", (event) => {
    if (event.key === key) soundWanted.value = stored();
  });
  // A touch is what the browser waits for.
  const touched = () => {
    if (soundBlocked.value) void play([]);
  };
  window.addEventListener("pointerdown", touched);
  window.addEventListener("keydown", touched);
}
