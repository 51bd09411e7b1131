/** Who leads which hand, and with what. */

import type { Client, HandSetup } from "../protocol/messages";

/** Index of the pointer in the list of devices. */
export const kPointer = 0;

/** Does a mouse move the hand? An emulated device is held by one as well. */
export function followsPointer(hands: readonly HandSetup[], hand: number): boolean {
  const setup = hands.find((each) => each.hand === hand);
  return setup === undefined
    ? hand === 0 && hands.length === 0
    : setup.device.index === kPointer || setup.device.is_emulated;
}

/** May the mouse of this page move the hand? */
export function isPointerHand(hands: readonly HandSetup[], own: readonly number[], hand: number): boolean {
  return followsPointer(hands, hand) && own.includes(hand);
}

/** The hand after this one, of those that a page leads; after the last one the first. */
export function handAfter(own: readonly number[], hand: number): number {
  return own[(own.indexOf(hand) + 1) % own.length] ?? hand;
}

/** The hand that one of a user's two leads, of those that the page leads: the right one leads the first; null where it leads none. */
export function handOfUser(own: readonly number[], isLeft: boolean): number | null {
  return own[Math.min(isLeft ? 1 : 0, own.length - 1)] ?? null;
}

/** The client that leads a hand. */
export function leaderOf(clients: readonly Client[], hand: number): Client | null {
  return clients.find((client) => (client.hands ?? (client.has_lease ? [0] : [])).includes(hand)) ?? null;
}

/** How much of the most that there may be is there now, from 0 to 1. */
export function forceShare(forceN: number, mostN: number | null): number {
  return mostN !== null && mostN > 0 ? Math.min(1, Math.max(0, forceN / mostN)) : 0;
}

/** What the device of a hand is told to do: 0 for the scale of its profile. Null for what is no number. */
export function parseScale(text: string): number | null {
  const trimmed = text.trim().replace(",", ".");
  if (trimmed === "") {
    return 0;
  }
  const value = Number(trimmed);
  return Number.isFinite(value) && value > 0 && value <= 100 ? value : null;
}

/** What is the matter with each hand's device, after news of one of them. */
export function withTrouble(
  before: ReadonlyMap<number, string>,
  news: { hand: number; condition: string; text: string },
): ReadonlyMap<number, string> {
  const after = new Map(before);
  after.delete(news.hand);
  if (news.condition !== "ready") {
    after.set(news.hand, news.text);
  }
  return after;
}

/** The troubles that last: a hand that is gone, or has another device that is ready, has none. */
export function lastingTroubles(
  troubles: ReadonlyMap<number, string>,
  hands: readonly HandSetup[],
): ReadonlyMap<number, string> {
  const isTroubled = (hand: number) => hands.some((each) => each.hand === hand && each.condition !== "ready");
  return new Map([...troubles].filter(([hand]) => isTroubled(hand)));
}
