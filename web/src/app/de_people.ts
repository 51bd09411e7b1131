import type { enPeople } from "./en_people";

/** German, of working with others. */
export const dePeople: Record<keyof typeof enPeople, string> = {
  "people.title": "Personen",
  "people.ownName": "Ihr Name, wie andere ihn sehen",
  "people.namePlaceholder": "Nicht angegeben",
  "people.guest": "Gast {n}",
  "people.self": "{name} (Sie)",
  "people.steers": "steuert die Montage: {hands}",
  "people.helps": "hilft: {hands}",
  "people.looks": "schaut zu",
  "people.follow": "Ansicht folgen",
  "people.unfollow": "Nicht mehr folgen",
  "people.followed": "Sie folgen der Ansicht von {name}. Bewegen Sie die Ansicht, um das zu beenden.",
  "people.chip": "{n} andere sind hier: {names}",
  "people.end": "Freigabe beenden",
  "people.ended": "Die Freigabe ist beendet: Die anderen sind nicht mehr hier, und ihre Links sind ungültig.",
  "people.handAsked": "{name} möchte mit einer eigenen Hand mitarbeiten (Hand {n}).",
  "people.controlAsked": "{name} bittet um die Steuerung.",
  "action.holdTogether": "Zusammen halten",
  "action.note": "Notiz an das Teil heften…",
  "note.title": "Notiz anheften",
  "note.text": "Notiz zu {part}",
  "note.pin": "Anheften",
  "note.remove": "Entfernen",
  "note.of": "Notiz {n} zu {part}, von {by}",
};
