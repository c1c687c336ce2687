import { sentenceOf } from "../api/client";
import { service } from "../api/live";
import type { ExportJob } from "../api/types";
import { Button } from "../ui/Button";
import { bytes, fixed } from "../ui/numbers";
import { CopyButton } from "./CopyButton";
import { downloadWithToken, hasEnded } from "./export_jobs";
import type { ExportJobs } from "./export_jobs";

interface Props {
  exports: ExportJobs;
}

/** What is being written and what was, with what can be downloaded. */
export function ExportList({ exports }: Props) {
  const jobs = exports.jobs.value;
  if (jobs.length === 0) return null;
  return (
    <section aria-labelledby="exports-title">
      <h3 id="exports-title">Exports</h3>
      <ul class="export-list">
        {jobs.map((job) => (
          <ExportRow key={job.id} job={job} exports={exports} />
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

function ExportRow({ job, exports }: { job: ExportJob; exports: ExportJobs }) {
  return (
    <li
      class="export"
      data-role="export"
      data-kind={job.kind}
      data-state={job.state}
      data-id={job.id}
    >
      <div class="export-words">
        <strong>{kinds[job.kind]}</strong> {job.sentence || job.state}
        {!hasEnded(job) && <span class="muted"> {progressWords(job)}</span>}
      </div>
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
        <Button onClick={() => void exports.remove(job)}>
          {hasEnded(job) ? "Remove" : "Cancel"}
        </Button>
      </div>
    </li>
  );
}

interface DownloadProps {
  exports: ExportJobs;
  name: string;
  bytes: number;
  url: string;
}

function Download({ exports, name, bytes: size, url }: DownloadProps) {
  const words = `Download ${name} (${bytes(size)})`;
  if (service.value?.reading !== "token") {
    return (
      <a class="button button-link" href={url} download={name}>
        {words}
      </a>
    );
  }
  const fetchIt = () =>
    downloadWithToken(url, name).catch((error) => (exports.failure.value = sentenceOf(error)));
  return <Button onClick={() => void fetchIt()}>{words}</Button>;
}
