import { effect } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { connection, service, status } from "../api/live";
import type { Connection } from "../api/live";
import type { Service, Status } from "../api/types";
import alarmIcon from "./favicon_alarm.svg";
import { sampleName } from "./sample_name";
import { isStartLatch, wordsOf } from "./state_words";

/** What the tab is called, so that it tells among other tabs. */
export function tabTitle(
  now: Status | null,
  known: Service | null,
  state: Connection["state"],
): string {
  const sample = sampleName(now, known);
  const place = sample ? `${sample} – Biotomy` : "Biotomy";
  if (now?.alarm && !isStartLatch(now)) return `⚠ ALARM – ${place}`;
  if (state === "lost") return `Connection lost – ${place}`;
  // What was so when somebody last looked need not be so now; only an alarm is worth a look anyhow.
  if (!now || state === "resting") return place;
  const { short } = wordsOf(now.state);
  return `${short}${now.layers > 0 ? ` ${now.committed}/${now.layers}` : ""} – ${place}`;
}

/** The tab's title and its icon follow the rig. */
export function useTabSign(): void {
  useEffect(() => {
    const icon = document.querySelector<HTMLLinkElement>('link[rel="icon"]');
    const usual = icon?.href ?? "";
    return effect(() => {
      const now = status.value;
      document.title = tabTitle(now, service.value, connection.value.state);
      const wanted = now?.alarm && !isStartLatch(now) ? alarmIcon : usual;
      if (icon && icon.getAttribute("href") !== wanted) icon.setAttribute("href", wanted);
    });
  }, []);
}
