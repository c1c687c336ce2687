import type { Service, Status } from "../api/types";

/** The sample's name, of what is known: a folder's last part. */
export function sampleName(now: Status | null, known: Service | null): string {
  const text = known?.sample || now?.sample || "";
  return (
    text
      .replace(/[/\\]+$/, "")
      .split(/[/\\]/)
      .pop() ?? ""
  );
}
