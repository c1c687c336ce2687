import type { ExportJob } from "../api/types";
import { Button } from "../ui/Button";
import { fixed, percent } from "../ui/numbers";
import type { ExportJobs } from "./export_jobs";

interface Props {
  exports: ExportJobs;
  onClick: () => void;
}

/** Opens the exports; it tells of them while nobody looks at the list. */
export function ExportButton({ exports, onClick }: Props) {
  const job = exports.underWay.value;
  const news = exports.news.value;
  return (
    <span class="export-button">
      <span class={news?.state === "failed" ? "export-news bad" : "export-news good"} role="status">
        {news && (news.state === "failed" ? "Export failed" : "Export ready")}
      </span>
      <Button kind="primary" onClick={onClick}>
        Export…{job && ` ${progressWords(job)}`}
      </Button>
    </span>
  );
}

function progressWords({ done, total, unit }: ExportJob): string {
  if (unit === "frames") return `${fixed(done)}/${fixed(total)}`;
  return percent(total > 0 ? (100 * done) / total : 0);
}
