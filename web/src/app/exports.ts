/** Files and links: in by the chooser, out as pictures, tables and addresses. */

import { encodeView } from "../model/view_link";
import { store, studio, viewport } from "./app_state";
import { t } from "./i18n";

export const acceptedFiles = ".step,.stp,.iges,.igs,.glb,.gltf,.obj,.stl";

export function chooseFile(): void {
  const input = document.createElement("input");
  input.type = "file";
  input.accept = acceptedFiles;
  input.onchange = () => {
    const file = input.files?.[0];
    if (file !== undefined) {
      void studio.openUpload(file);
    }
  };
  input.click();
}

function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  studio.notify(t("notice.saved", { file: name }));
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
  const rows = store.runs.value.map((run) =>
    [JSON.stringify(run.name), run.wasSeated ? 1 : 0, ...columns.map((c) => run.metrics[c])].join(","),
  );
  const text = [["part", "was_seated", ...columns].join(","), ...rows.reverse(), ""].join("\n");
  save(new Blob([text], { type: "text/csv" }), `${stem()}_runs.csv`);
}

export async function copyLink(): Promise<void> {
  const shared = viewport.value?.sharedView();
  if (shared === undefined) {
    return;
  }
  history.replaceState(null, "", `#${encodeView(shared)}`);
  try {
    await navigator.clipboard.writeText(location.href);
    studio.notify(t("notice.copied"));
  } catch {
    studio.notify(t("notice.copyFailed"));
  }
}
