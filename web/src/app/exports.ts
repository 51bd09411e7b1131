/** Files and links: in by the chooser, out as pictures, tables and addresses. */

import { csvText, type CsvCell } from "../model/csv";
import { kTraceFields, readSeries } from "../model/trace";
import { encodeMoment, encodeView } from "../model/view_link";
import { store, studio, viewport } from "./app_state";
import { t } from "./i18n";
import { plottedHand, shownSpan, traceOf } from "./time_source";

export const acceptedFiles = ".step,.stp,.iges,.igs,.glb,.gltf,.obj,.stl,.3mf";

export function chooseFile(): void {
  const input = document.createElement("input");
  input.type = "file";
  input.accept = acceptedFiles;
  input.onchange = () => {
    const file = input.files?.[0];
    if (file !== undefined) {
      void studio.opening.upload(file);
    }
  };
  input.click();
}

export function saveTable(rows: readonly (readonly CsvCell[])[], name: string): void {
  // Seven figures are all that a frame's numbers have.
  const cell = (value: CsvCell) => (typeof value === "string" ? value : Number(value.toPrecision(7)));
  save(new Blob([csvText(rows.map((row) => row.map(cell)))], { type: "text/csv" }), `${stem()}_${name}.csv`);
}

function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  studio.notify(t("notice.saved", { file: name }));
}

export function saveText(text: string, name: string, type: string): void {
  save(new Blob([text], { type }), name);
}

/** What the server has made, as a file. */
export async function saveUrl(url: string, name: string): Promise<void> {
  const answer = await fetch(url);
  if (answer.ok) {
    save(await answer.blob(), name);
  } else {
    studio.notify(`${answer.status} ${answer.statusText}`, true);
  }
}

function stem(): string {
  const name = store.scene.value?.name ?? "studio";
  return name.replace(/[^\p{L}\p{N}]+/gu, "_");
}

export async function saveScreenshot(): Promise<void> {
  const picture = await viewport.value?.screenshot();
  if (picture) {
    save(picture, `${stem()}.png`);
  }
}

export function saveRuns(): void {
  const columns = ["time_s", "path_mm", "peak_true_n", "peak_felt_n", "fit_true_n", "depth_um", "insertion_mm"] as const;
  const rows = store.runs.value.map((run) => [run.name, run.wasSeated ? 1 : 0, ...columns.map((c) => run.metrics[c])]);
  saveTable([["part", "was_seated", ...columns], ...rows.reverse()], "runs");
}

/** What the plots show, every sample of it. */
export function savePlot(): void {
  const { fromS, toS } = shownSpan();
  const { timesS, columns } = readSeries(traceOf(plottedHand()), kTraceFields, fromS, toS, Infinity);
  const rows = timesS.map((timeS, k) => [Number((timeS - fromS).toFixed(6)), ...columns.map((column) => column[k] ?? 0)]);
  saveTable([["time_s", ...kTraceFields], ...rows], "plot");
}

/** What stands for this view, and of a recording for its moment, in a link; "" while there is none. */
export function shownFragment(): string {
  const shared = viewport.value?.sharedView();
  if (shared === undefined) {
    return "";
  }
  const playback = studio.recordings.playback.peek();
  const moment =
    playback === null ? "" : encodeMoment({ recording: playback.run.detail.id, timeS: playback.timeS });
  return `${encodeView(shared)}${moment}`;
}
