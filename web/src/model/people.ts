/** Who is in the studio, where the others look, and the notes that are pinned to parts. */

import type { Client, HandSetup, ServerEvent } from "../protocol/messages";
import { kMaxHands } from "../protocol/frames";
import { dropAnswered, noteAsking } from "./asking";
import type { Store } from "./store";

export type OthersEvent = Extract<ServerEvent, { event: "lease_asked" | "part_asked" | "looking" | "notes" }>;

/** Okabe and Ito, "Color Universal Design", 2008: told apart with all kinds of colour vision. */
const kColours = ["#56b4e9", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#0072b2", "#f0e442", "#999999"] as const;

/** Of a client, the same on every page: ids are c1, c2 and so on. */
export function colourOf(client: string): string {
  const number = Number(client.slice(1));
  return kColours[(Number.isInteger(number) && number > 0 ? number - 1 : 0) % kColours.length]!;
}

export function noteOthers(store: Store, event: OthersEvent): void {
  if (event.event === "looking") {
    store.looking.value = new Map(store.looking.value).set(event.client, event);
  } else if (event.event === "notes") {
    store.notes.value = event.notes;
  } else {
    noteAsking(store, event);
  }
}

/** Who is here now, and what this page may do. */
export function noteClients(store: Store, clients: readonly Client[]): void {
  store.clients.value = clients;
  const own = clients.find((client) => client.id === store.client.value);
  if (own !== undefined) {
    store.role.value = own.role;
    store.hasLease.value = own.has_lease;
  }
  dropAnswered(store, clients, own?.hands ?? []);
  dropGone(store, clients);
}

/** Who has left looks at nothing any more, and nobody follows them. */
function dropGone(store: Store, clients: readonly Client[]): void {
  const isHere = (id: string) => clients.some((client) => client.id === id);
  if ([...store.looking.value.keys()].some((id) => !isHere(id))) {
    store.looking.value = new Map([...store.looking.value].filter(([id]) => isHere(id)));
  }
  if (store.followed.value !== null && !isHere(store.followed.value)) {
    store.followed.value = null;
  }
}

/** The hand for somebody who joins: one that nobody leads, else a further one, else the last one of whoever steers. */
export function handToJoin(hands: readonly HandSetup[], clients: readonly Client[]): number {
  const leaders = new Map(clients.flatMap((client) => (client.hands ?? []).map((hand) => [hand, client] as const)));
  const free = hands.find(({ hand }) => hand > 0 && !leaders.has(hand));
  if (free !== undefined) {
    return free.hand;
  }
  if (hands.length < kMaxHands) {
    return Math.max(1, hands.length);
  }
  const ofSteerer = hands.filter(({ hand }) => hand > 0 && leaders.get(hand)?.has_lease === true);
  return ofSteerer.at(-1)?.hand ?? kMaxHands - 1;
}
