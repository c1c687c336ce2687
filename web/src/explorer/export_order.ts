import type { ExplorerState } from "./explorer_state";
import type { ExportFormat, ExportOrder } from "./export_jobs";
import { choicesQuery } from "./section_query";
import type { Query } from "./section_query";
import { seriesQuery } from "./series_choice";
import type { SeriesChoice } from "./series_choice";

/** What is chosen in the dialog. */
export interface ExportChoice {
  kind: "section" | "series";
  format: ExportFormat;
  pixel: number | null; // micrometres; none: full resolution
  movie: boolean;
  frames: boolean;
  rate: number;
}

export const defaultExport: ExportChoice = {
  kind: "section",
  format: "png",
  pixel: null,
  movie: true,
  frames: true,
  rate: 25,
};

/** The pixel that was typed, where one was. */
export const pixelQuery = ({ pixel }: ExportChoice): Query =>
  pixel === null ? {} : { pixel: String(pixel) };

/** None while there is no section, or where nothing would be written. */
export function orderOf(
  state: ExplorerState,
  series: SeriesChoice,
  choice: ExportChoice,
): ExportOrder | null {
  const { kind, format, movie, frames, rate } = choice;
  const placed = state.placed.value;
  const cuboid = state.cuboid.value;
  const section = state.shownQuery.value;
  if (!placed || !cuboid || !section) return null;
  if (kind === "section") {
    const parameters = { ...section, ...pixelQuery(choice) };
    return { kind, format, parameters, movie: false, frames: true };
  }
  if (!movie && !frames) return null;
  return {
    kind,
    format,
    parameters: { ...choicesQuery(state.choices.value), ...pixelQuery(choice) },
    series: seriesQuery(series, placed, cuboid),
    movie,
    frames,
    rate,
  };
}
