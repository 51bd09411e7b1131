/** What others point to, and the notes on parts, over the picture. */

import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { add, rotate, type Vec3 } from "../model/math";
import { colourOf } from "../model/people";
import type { Note } from "../protocol/messages";
import { store, studio, viewport } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";
import { useLive } from "./live";
import { clientName } from "./people";

/** Keeps an element where a point of W is seen. */
function useAnchor(pointOf: () => Vec3 | null) {
  const element = useRef<HTMLDivElement>(null);
  useLive(() => {
    const p = pointOf();
    const at = p === null ? undefined : viewport.value?.project(p);
    if (element.current !== null) {
      element.current.hidden = at === undefined || at.isBehind;
      element.current.style.transform = at === undefined ? "" : `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
    }
  }, 0);
  return element;
}

function Cursor({ id }: { id: string }) {
  const element = useAnchor(() => store.looking.value.get(id)?.p_m ?? null);
  return (
    <div class="other-cursor" ref={element} hidden style={{ "--person": colourOf(id) }} aria-hidden="true">
      <span data-testid={`cursor-${id}`}>{clientName(id)}</span>
    </div>
  );
}

function Pin({ note, number }: { note: Note; number: number }) {
  const isOpen = useSignal(false);
  const element = useAnchor(() => {
    const X_WB = viewport.value?.product.poseOf(note.occurrence) ?? null;
    return X_WB === null ? null : add(X_WB.p, rotate(X_WB.q, note.p_B_m));
  });
  const part = store.occurrences.value.get(note.occurrence)?.name ?? "";
  return (
    <div class="note-pin" ref={element} hidden data-testid={`note-${note.id}`}>
      <button
        type="button"
        class="note-head"
        aria-expanded={isOpen.value}
        aria-label={t("note.of", { n: number, part, by: note.by })}
        onClick={() => (isOpen.value = !isOpen.value)}
      >
        {number}
      </button>
      {isOpen.value ? (
        <div class="note-card" role="note">
          <p>{note.text}</p>
          <p class="quiet">
            {note.by} · {part}
          </p>
          {store.role.value === "operator" ? (
            <button type="button" class="small-button" onClick={() => void studio.command({ command: "remove_note", note: note.id })}>
              <Icon name="close" size={12} /> {t("note.remove")}
            </button>
          ) : null}
        </div>
      ) : null}
    </div>
  );
}

export function PeopleMarks() {
  if (store.study.value !== null || store.replay.value !== null) {
    return null;
  }
  return (
    <div class="view-marks">
      {[...store.looking.value.keys()].map((id) => (
        <Cursor key={id} id={id} />
      ))}
      {store.notes.value.map((note, i) => (
        <Pin key={note.id} note={note} number={i + 1} />
      ))}
    </div>
  );
}
