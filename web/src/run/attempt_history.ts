import type { Attempt, History } from "../api/types";
import { isRejected } from "../journal/verdict_words";

/** Of a metric, or of the focus position: a value for each attempt, and what it was held against. */
export interface Column {
  value: (number | null)[];
  limit: (number | null)[];
}

type MadeAttempt = Pick<Attempt, "id" | "layer" | "attempt" | "verdict" | "column_um">;

/**
 * All attempts of the job as columns, in the order in which they were made: what was fetched, and
 * then what the event stream told.
 */
export class AttemptHistory {
  last = 0; // id of the last attempt
  readonly layer: number[] = [];
  readonly attempt: number[] = []; // at its layer, from 1
  readonly rejected: boolean[] = [];
  readonly columns = new Map<string, Column>();
  rejectedCount = 0;

  /** `metrics`: which are kept. */
  constructor(readonly metrics: readonly string[]) {
    for (const name of [...metrics, "column_um"]) this.columns.set(name, { value: [], limit: [] });
  }

  get length(): number {
    return this.layer.length;
  }

  column(name: string): Column {
    return this.columns.get(name) ?? { value: [], limit: [] };
  }

  /** Adds what was fetched, apart from what is here already. */
  load(history: History): void {
    history.id.forEach((id, row) => {
      if (id <= this.last) return;
      const made = {
        id,
        layer: history.layer[row],
        attempt: history.attempt[row],
        verdict: history.verdict[row],
        column_um: history.column_um[row],
      };
      this.add(made, (name) => {
        const column = history.metrics[name];
        return [column?.value[row] ?? null, column?.limit[row] ?? null];
      });
    });
  }

  /** False when it is here already. */
  append(attempt: Attempt): boolean {
    if (attempt.id <= this.last) return false;
    this.add(attempt, (name) => {
      const metric = attempt.metrics.find((candidate) => candidate.name === name);
      return [metric?.value ?? null, metric?.limit ?? null];
    });
    return true;
  }

  private add(
    { id, layer, attempt, verdict, column_um }: MadeAttempt,
    metric: (name: string) => [number | null, number | null],
  ): void {
    this.last = id;
    this.layer.push(layer);
    this.attempt.push(attempt);
    const rejected = isRejected(verdict);
    this.rejected.push(rejected);
    if (rejected) this.rejectedCount += 1;
    for (const name of this.metrics) this.push(name, ...metric(name));
    this.push("column_um", column_um, null);
  }

  private push(name: string, value: number | null, limit: number | null): void {
    const column = this.column(name);
    column.value.push(value);
    column.limit.push(limit);
  }
}
