/** The recordings that the server keeps. */

import { useSignal, type Signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { RecordingEntry } from "../protocol/messages";
import { store, studio, ui } from "./app_state";
import { Dialog, DialogHead } from "./dialog";
import { dateTime, duration, megabytes, t } from "./i18n";
import { Icon } from "./icons";
import { openRecording } from "./time_source";

const close = () => (ui.overlay.value = null);

function show(id: string): void {
  close();
  void openRecording(id);
}

function compareChosen(): void {
  ui.panels.plots.value = true;
  ui.bottomTab.value = "compare";
  close();
}

function choose(id: string, isChosen: boolean): void {
  const others = ui.compared.value.filter((each) => each !== id);
  ui.compared.value = isChosen ? [...others, id] : others;
}

function DeleteButton({ entry }: { entry: RecordingEntry }) {
  const isAsking = useSignal(false);
  if (isAsking.value) {
    return (
      <span class="confirm" role="group" aria-label={t("recs.deleteSure", { name: entry.name })}>
        <span>{t("recs.sure")}</span>
        <button
          type="button"
          class="small-button is-bad"
          data-testid="confirm-delete"
          autofocus
          onClick={() => void studio.recordings.remove(entry.id)}
        >
          {t("recs.delete")}
        </button>
        <button type="button" class="small-button" onClick={() => (isAsking.value = false)}>
          {t("recs.keep")}
        </button>
      </span>
    );
  }
  return (
    <button
      type="button"
      class="icon-button"
      aria-label={t("recs.deleteWhat", { name: entry.name })}
      title={t("recs.delete")}
      disabled={!store.isOwner.value}
      onClick={() => (isAsking.value = true)}
    >
      <Icon name="trash" />
    </button>
  );
}

/** The name leads to the recording, or is being changed. */
function Name({ entry, isNaming }: { entry: RecordingEntry; isNaming: Signal<boolean> }) {
  const text = useSignal(entry.name);
  if (!isNaming.value) {
    return (
      <button type="button" class="link-button" onClick={() => show(entry.id)}>
        {entry.name}
      </button>
    );
  }
  const save = (event: Event) => {
    event.preventDefault();
    const name = text.value.trim();
    isNaming.value = false;
    if (name !== "" && name !== entry.name) {
      void studio.recordings.rename(entry.id, name);  // a refusal is told below the list
    }
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key === "Escape") {
      event.preventDefault();
      event.stopPropagation();
      isNaming.value = false;
    }
  };
  return (
    <form class="rename" onSubmit={save}>
      <input
        value={text.value}
        maxLength={100}
        aria-label={t("recs.newName", { name: entry.name })}
        data-testid="recording-name"
        autofocus
        onInput={(event) => (text.value = event.currentTarget.value)}
        onKeyDown={onKeyDown}
      />
      <button type="submit" class="small-button is-main">
        {t("recs.save")}
      </button>
    </form>
  );
}

function Row({ entry }: { entry: RecordingEntry }) {
  const isChosen = ui.compared.value.includes(entry.id);
  const isNaming = useSignal(false);
  return (
    <tr data-testid={`recording-${entry.id}`}>
      <td>
        <input
          type="checkbox"
          checked={isChosen}
          aria-label={t("recs.compareWhat", { name: entry.name })}
          onChange={(event) => choose(entry.id, event.currentTarget.checked)}
        />
      </td>
      <th scope="row">
        <Name entry={entry} isNaming={isNaming} />
        {entry.is_shared ? <span class="badge">{t("recs.shared")}</span> : null}
        {entry.is_complete ? null : <span class="badge is-next">{t("recs.incomplete")}</span>}
      </th>
      <td>{entry.product}</td>
      <td>{dateTime(entry.started_unix_ms)}</td>
      <td class="is-number">{duration(entry.duration_s)}</td>
      <td class="is-number">{megabytes(entry.bytes)}</td>
      <td class="row-buttons">
        <button type="button" class="icon-button" aria-label={t("recs.playWhat", { name: entry.name })} title={t("recs.play")} onClick={() => show(entry.id)}>
          <Icon name="play" />
        </button>
        <button
          type="button"
          class="icon-button"
          aria-label={t("recs.renameWhat", { name: entry.name })}
          title={t("recs.rename")}
          disabled={!store.isOwner.value}
          onClick={() => (isNaming.value = true)}
        >
          <Icon name="pen" />
        </button>
        <button
          type="button"
          class="icon-button"
          aria-label={t("recs.shareWhat", { name: entry.name })}
          aria-pressed={entry.is_shared}
          title={t("recs.share")}
          data-testid={`share-${entry.id}`}
          disabled={!store.isOwner.value}
          onClick={() => void studio.recordings.share(entry.id, !entry.is_shared)}
        >
          <Icon name="share" />
        </button>
        <a
          class="icon-button"
          href={`/api/recording/${encodeURIComponent(entry.id)}/file`}
          download
          aria-label={t("recs.downloadWhat", { name: entry.name })}
          title={t("recs.download")}
        >
          <Icon name="download" />
        </a>
        <DeleteButton entry={entry} />
      </td>
    </tr>
  );
}

const kColumns = ["recs.name", "recs.product", "recs.date", "recs.duration", "recs.size"] as const;

export default function RecordingsDialog() {
  const list = store.recordings.value;
  useEffect(() => void studio.recordings.fetchList(), []);
  const chosen = ui.compared.value.length;
  return (
    <Dialog title={t("recs.title")} kind="recordings" onClose={close}>
      <DialogHead title={t("recs.title")} onClose={close} />
      {list === null ? (
        <p class="quiet">{t("lazy.loading")}</p>
      ) : list.length === 0 ? (
        <p class="quiet">{t("recs.none")}</p>
      ) : (
        <div class="table-room" tabIndex={0} role="region" aria-label={t("recs.title")}>
          <table class="table">
            <thead>
              <tr>
                <td>
                  <span class="sr-only">{t("recs.compare")}</span>
                </td>
                {kColumns.map((key) => (
                  <th key={key} scope="col" class={key === "recs.duration" || key === "recs.size" ? "is-number" : ""}>
                    {t(key)}
                  </th>
                ))}
                <td />
              </tr>
            </thead>
            <tbody>
              {list.map((entry) => (
                <Row key={entry.id} entry={entry} />
              ))}
            </tbody>
          </table>
        </div>
      )}
      <footer class="dialog-foot">
        <span class="quiet">{t("recs.compareHelp")}</span>
        <button type="button" class="small-button is-main" disabled={chosen < 2} data-testid="compare-chosen" onClick={compareChosen}>
          {t("recs.compareChosen", { n: chosen })}
        </button>
      </footer>
    </Dialog>
  );
}
