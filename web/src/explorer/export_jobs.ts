import { computed, signal } from "@preact/signals";

import { deleteAt, getBlob, getJson, isAbort, postJson, request, sentenceOf } from "../api/client";
import { onExport, onGap } from "../api/live";
import type { ExportJob } from "../api/types";
import type { Query } from "./section_query";

export type ExportFormat = "png" | "tiff" | "jpeg";

/** What POST /api/v1/exports takes. */
export interface ExportOrder {
  kind: "section" | "series";
  format: ExportFormat;
  parameters: Query;
  series?: Query;
  movie: boolean;
  frames: boolean;
  rate?: number; // of the film, frames in a second
}

const path = "/api/v1/exports";
const ended = new Set(["done", "failed", "cancelled"]);
export const hasEnded = (job: ExportJob): boolean => ended.has(job.state);

const stages = { queued: 0, running: 1, done: 2, failed: 2, cancelled: 2 };

/** The one that is further: an answer may come after an event that was sent later. */
function further(job: ExportJob, known: ExportJob | undefined): ExportJob {
  if (!known) return job;
  const stage = stages[job.state] - stages[known.state];
  return stage > 0 || (stage === 0 && job.done >= known.done) ? job : known;
}

/** The exports that the server knows of, the newest first, as they go on. */
export class ExportJobs {
  readonly jobs = signal<ExportJob[]>([]);
  readonly failure = signal("");
  /** An order is on its way. */
  readonly ordering = signal(false);
  /** The addresses of files that are being fetched by the page itself. */
  readonly downloads = signal<ReadonlySet<string>>(new Set());
  /** That ended last, until somebody has seen it. */
  readonly news = signal<ExportJob | null>(null);
  readonly underWay = computed(() => this.jobs.value.find(({ state }) => state === "running"));
  private readonly forgotten = new Set<ExportJob["id"]>();

  /** Returns what ends it. */
  watch(): () => void {
    const stops = [onExport((job) => this.take(job)), onGap(() => void this.learn())];
    return () => stops.forEach((stop) => stop());
  }

  async learn(): Promise<void> {
    await this.attempt(async () => {
      const before = new Set(this.jobs.value.map(({ id }) => id));
      const { exports } = await getJson<{ exports: ExportJob[] }>(path);
      const told = new Set(exports.map(({ id }) => id));
      // Of what was ordered or removed while it was on its way, the answer need not know.
      const ordered = this.jobs.value.filter(({ id }) => !before.has(id) && !told.has(id));
      const kept = exports.filter(({ id }) => !this.forgotten.has(id));
      this.put([...ordered, ...kept.map((job) => further(job, this.known(job.id)))]);
    });
  }

  async order(order: ExportOrder): Promise<void> {
    if (this.ordering.value) return; // a second press is no second order
    this.ordering.value = true;
    await this.attempt(async () => this.take(await postJson<ExportJob>(path, order)));
    this.ordering.value = false;
  }

  /** Stops it, or forgets it and its files when it has ended. */
  async remove(job: ExportJob): Promise<void> {
    await this.attempt(async () => {
      await deleteAt(`${path}/${job.id}`);
      if (!hasEnded(job)) return;
      this.forgotten.add(job.id);
      this.jobs.value = this.jobs.value.filter(({ id }) => id !== job.id);
    });
  }

  /** Where reading needs a token, a plain link can't bring it: the file is fetched and handed on. */
  async download(url: string, name: string): Promise<void> {
    if (this.downloads.value.has(url)) return;
    this.downloads.value = new Set([...this.downloads.value, url]);
    await this.attempt(() => downloadWithToken(url, name));
    this.downloads.value = new Set([...this.downloads.value].filter((other) => other !== url));
  }

  private take(job: ExportJob): void {
    this.put(
      this.known(job.id)
        ? this.jobs.value.map((old) => (old.id === job.id ? further(job, old) : old))
        : [job, ...this.jobs.value],
    );
  }

  private put(jobs: ExportJob[]): void {
    for (const job of jobs) {
      const before = this.known(job.id);
      const ends = before && !hasEnded(before) && hasEnded(job);
      if (ends && job.state !== "cancelled") this.news.value = job;
    }
    this.jobs.value = jobs;
  }

  private known(id: ExportJob["id"]): ExportJob | undefined {
    return this.jobs.value.find((job) => job.id === id);
  }

  private async attempt(work: () => Promise<void>): Promise<void> {
    this.failure.value = "";
    try {
      await work();
    } catch (error) {
      if (!isAbort(error)) this.failure.value = sentenceOf(error);
    }
  }
}

/** Of browsers that let a page write a file, where it came over https or from their own computer. */
interface FilePicker {
  showSaveFilePicker?(options: { suggestedName: string }): Promise<FileSystemFileHandle>;
}

async function downloadWithToken(url: string, name: string): Promise<void> {
  const file = await (window as FilePicker).showSaveFilePicker?.({ suggestedName: name });
  if (file) await writeTo(await file.createWritable(), url);
  else await hold(url, name);
}

/** As it comes, whatever its size. */
async function writeTo(file: WritableStream, url: string): Promise<void> {
  try {
    await (await request(url)).body?.pipeTo(file);
  } catch (error) {
    await file.abort(); // nothing is left of it on the disk
    throw error;
  }
}

/** In the page's memory, until the browser has it. */
async function hold(url: string, name: string): Promise<void> {
  const held = URL.createObjectURL(await getBlob(url));
  const link = document.createElement("a");
  link.href = held;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(held), 60_000);
}
