import { ApiError, blobOf, getJson, request } from "../api/client";
import { connection } from "../api/live";
import { retryWaitMs } from "../api/retry_wait";
import type { SectionRecord } from "./section_record";
import { queryText } from "./section_query";
import type { Query } from "./section_query";

const recordHeader = "Biotomy-Section";

/**
 * A picture with its record. It is decoded as it is: no profile and no transparency changes its
 * values.
 */
export async function fetchPicture(
  address: string,
  signal: AbortSignal,
): Promise<{ image: ImageBitmap; record: SectionRecord }> {
  const response = await request(address, { signal });
  const record = JSON.parse(response.headers.get(recordHeader) ?? "null") as SectionRecord | null;
  if (!record) throw new Error(`The answer has no header ${recordHeader}.`);
  const image = await createImageBitmap(await blobOf(response), {
    premultiplyAlpha: "none",
    colorSpaceConversion: "none",
  });
  return { image, record };
}

export const sectionAddress = (query: Query): string => `/api/v1/section?${queryText(query)}`;

/** Where a section lies and how large its picture would be, without the picture. */
export const fetchOutline = (query: Query, signal?: AbortSignal): Promise<SectionRecord> =>
  getJson(`/api/v1/section/outline?${queryText(query)}`, signal);

const usualWait_ms = 500;

/**
 * After how long to ask again, of a busy server or for an answer that was lost on its way; null for a
 * refusal that stands, and where nobody answers: then it is the connection that has to come back.
 */
export const busyWait_ms = (error: unknown): number | null =>
  error instanceof ApiError || connection.peek().state === "live"
    ? retryWaitMs(error, usualWait_ms)
    : null;
