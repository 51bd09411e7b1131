/** Tables as spreadsheets exchange them (RFC 4180), with the rules of src/base/csv_row.h. */

export type CsvCell = string | number;

const kNumber = /^[+-]?(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?$/i;

/** Begins, also behind blanks or in full width, like a formula; or with a tab or a break. */
const kFormula = /^([\t\n\v\f\r]|[ \t\n\v\f\r]*[=+\-@\uff1d\uff0b\uff0d\uff20])/;

function textCell(text: string): string {
  const content = text.replace(/^'+/, "");
  const cell = kFormula.test(content) && content !== "-" && !kNumber.test(content) ? `'${text}` : text;
  return /[",;|\t\r\n\v\f]|^ | $/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell;
}

/** Names come from strangers' files: what begins like a formula gets an apostrophe. Numbers stay numbers. */
export function csvText(rows: readonly (readonly CsvCell[])[]): string {
  const cell = (value: CsvCell) => (typeof value === "string" ? textCell(value) : Number.isFinite(value) ? String(value) : "");
  return rows.map((row) => `${row.map(cell).join(",")}\n`).join("");
}
