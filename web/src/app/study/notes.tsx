/** What the experimenter wrote down. */

import { useSignal } from "@preact/signals";
import type { ExperimenterState, StudyNote } from "../../protocol/messages";
import { studio } from "../app_state";
import { language, t } from "../i18n";

function timeOf(unixMs: number): string {
  return new Intl.DateTimeFormat(language.value, { timeStyle: "medium" }).format(new Date(unixMs));
}

function Note({ note }: { note: StudyNote }) {
  const at = [timeOf(note.unix_ms), note.trial === null ? null : t("study.trial", { n: note.trial })].filter(
    (each) => each !== null,
  );
  return (
    <li>
      {note.text} <span class="quiet figures">{at.join(" · ")}</span>
    </li>
  );
}

export function Notes({ state }: { state: ExperimenterState }) {
  const text = useSignal("");
  const add = async (event: Event) => {
    event.preventDefault();
    const wanted = text.value.trim();
    if (wanted !== "" && (await studio.study.note(wanted))) {
      text.value = "";
    }
  };
  return (
    <section class="desk-card" aria-labelledby="desk-notes">
      <h3 id="desk-notes">{t("desk.notes")}</h3>
      <form class="desk-note" onSubmit={(event) => void add(event)}>
        <input
          value={text.value}
          aria-label={t("desk.note")}
          placeholder={t("desk.note")}
          data-testid="note-text"
          onInput={(event) => (text.value = event.currentTarget.value)}
        />
        <button type="submit" class="small-button" data-testid="note-add" disabled={text.value.trim() === ""}>
          {t("desk.noteAdd")}
        </button>
      </form>
      <ul class="desk-notes" data-testid="notes">
        {state.notes.map((note, k) => <Note key={k} note={note} />).reverse()}
      </ul>
    </section>
  );
}
