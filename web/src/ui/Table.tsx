import type { ComponentChildren } from "preact";

interface Props {
  caption?: string;
  head: ComponentChildren[];
  /** Rows of cells, as many as in `head`. */
  rows: ComponentChildren[][];
  /** Columns, from 0, whose cells are numbers. */
  numbers?: number[];
}

export function Table({ caption, head, rows, numbers = [] }: Props) {
  const kind = (column: number) => (numbers.includes(column) ? "number" : undefined);
  return (
    <div class="table-scroll" tabIndex={0} role="region" aria-label={caption ?? "Table"}>
      <table class="table">
        {caption && <caption>{caption}</caption>}
        <thead>
          <tr>
            {head.map((cell, column) => (
              <th key={column} scope="col" class={kind(column)}>
                {cell}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows.map((row, index) => (
            <tr key={index}>
              {row.map((cell, column) => (
                <td key={column} class={kind(column)}>
                  {cell}
                </td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
