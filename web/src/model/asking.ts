/** What others ask of this page: control of hands, and the part in a hand. */

import type { Client, ServerEvent } from "../protocol/messages";
import type { Store } from "./store";

export type Asking = Extract<ServerEvent, { event: "lease_asked" | "part_asked" }>;

export function noteAsking(store: Store, event: Asking): void {
  if (event.event === "lease_asked") {
    store.leaseAsked.value = event;
  } else {
    const held = store.held.value.find(({ hand }) => hand === event.hand);
    store.partAsked.value = held === undefined ? null : { ...event, occurrence: held.occurrence };
  }
}

/** Who has left asks for nothing any more, and nobody for hands that this page does not lead. */
export function dropAnswered(store: Store, clients: readonly Client[], own: readonly number[]): void {
  const isHere = (id: string | undefined) => clients.some((client) => client.id === id);
  const { leaseAsked, partAsked } = store;
  if (!isHere(leaseAsked.value?.by) || !own.some((hand) => leaseAsked.value?.hands.includes(hand))) {
    leaseAsked.value = null;
  }
  if (!isHere(partAsked.value?.by) || !own.includes(partAsked.value?.hand ?? -1)) {
    partAsked.value = null;
  }
}
