import { useSignal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";

import { service } from "../api/live";
import type { ExportJob } from "../api/types";
import { Button } from "../ui/Button";
import { bytes, fixed } from "../ui/numbers";
import { timeText } from "../ui/time_text";
import { askedBy } from "./command_words";
import { CopyButton } from "./CopyButton";
import { hasEnded } from "./export_jobs";
import type { ExportJobs } from "./export_jobs";

interface Props {
  exports: ExportJobs;
}

/** What is being written and what was, with what can be downloaded. */
export function ExportList({ exports }: Props) {
  const jobs = exports.jobs.value;
  const heading = useRef<HTMLHeadingElement>(null);
  const list = useRef<HTMLUListElement>(null);
  const removed = useRef<{ id: ExportJob["id"]; place: number } | null>(null);
  // The focus goes to what takes the place of a row that was removed.
  useLayoutEffect(() => {
    if (!removed.current || jobs.some(({ id }) => id === removed.current?.id)) return;
    const next = list.current?.children[removed.current.place];
    removed.current = null;
    (next?.querySelector<HTMLElement>("a, button") ?? heading.current)?.focus();
  }, [jobs]);
  const remove = (job: ExportJob) => {
    removed.current = { id: job.id, place: jobs.indexOf(job) };
    void exports.remove(job);
  };
  return (
    <section aria-labelledby="exports-title">
      <h3 id="exports-title" ref={heading} tabIndex={-1}>
        Exports
      </h3>
      {jobs.length === 0 && <p class="muted">None yet.</p>}
      <ul class="export-list" ref={list}>
        {jobs.map((job) => (
          <ExportRow key={job.id} job={job} exports={exports} onRemove={() => remove(job)} />
        ))}
      </ul>
    </section>
  );
}

const kinds = { section: "Section", series: "Series" };

function progressWords({ done, total, unit, seconds_left }: ExportJob): string {
  const far = total > 0 ? `${fixed(done)} of ${fixed(total)} ${unit}` : "";
  const left = seconds_left === null ? "" : `about ${Math.max(1, Math.round(seconds_left))} s left`;
  return [far, left].filter(Boolean).join(", ");
}

interface RowProps {
  job: ExportJob;
  exports: ExportJobs;
  onRemove: () => void;
}

function ExportRow({ job, exports, onRemove }: RowProps) {
  return (
    <li
      class="export"
      data-role="export"
      data-kind={job.kind}
      data-state={job.state}
      data-id={job.id}
    >
      <div class="export-words">
        <strong>{kinds[job.kind]}</strong> {timeText(job.created_at)}
        {job.state !== "done" && <>: {job.sentence || job.state}</>}
        {!hasEnded(job) && <span class="muted"> {progressWords(job)}</span>}
      </div>
      <code class="export-command">{askedBy(job.command)}</code>
      {!hasEnded(job) && (
        <progress
          max={Math.max(1, job.total)}
          value={job.done}
          aria-label={`${job.done} of ${job.total} ${job.unit}`}
        />
      )}
      <div class="button-row">
        {job.files.map((file) => (
          <Download key={file.name} exports={exports} {...file} />
        ))}
        {job.state === "done" && (
          <CopyButton what="The command that makes the same" text={() => job.command}>
            Copy as command
          </CopyButton>
        )}
        {hasEnded(job) ? (
          <RemoveButton onRemove={onRemove} />
        ) : (
          <Button onClick={() => void exports.remove(job)}>Cancel</Button>
        )}
      </div>
    </li>
  );
}

/** Its files can't be had back: a first press only asks. */
function RemoveButton({ onRemove }: { onRemove: () => void }) {
  const asked = useSignal(false);
  return (
    <Button
      kind={asked.value ? "danger" : "plain"}
      onClick={() => (asked.value ? onRemove() : (asked.value = true))}
      onBlur={() => (asked.value = false)}
    >
      {asked.value ? "Remove for good" : "Remove"}
    </Button>
  );
}

interface DownloadProps {
  exports: ExportJobs;
  name: string;
  bytes: number;
  url: string;
}

function Download({ exports, name, bytes: size, url }: DownloadProps) {
  const file = `${name} (${bytes(size)})`;
  if (service.value?.reading !== "token") {
    return (
      <a class="button button-link" href={url} download={name}>
        Download {file}
      </a>
    );
  }
  const underWay = exports.downloads.value.has(url);
  return (
    <Button disabled={underWay} onClick={() => void exports.download(url, name)}>
      {underWay ? "Downloading" : "Download"} {file}
    </Button>
  );
}
