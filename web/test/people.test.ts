/** Who is in the studio, and which hand somebody gets who joins. */

import { describe, expect, it } from "vitest";
import { colourOf, handToJoin, noteClients, noteOthers } from "../src/model/people";
import { makeStore } from "../src/model/store";
import type { Client, HandSetup } from "../src/protocol/messages";

function client(id: string, hands: number[], has_lease = hands.includes(0)): Client {
  return { id, name: "", role: "operator", has_lease, hands };
}

const all = [0, 1, 2, 3, 4, 5, 6, 7];
const setups = (count: number) => all.slice(0, count).map((hand) => ({ hand }) as HandSetup);
const without = (hands: number[]) => all.filter((hand) => !hands.includes(hand));

describe("the hand for somebody who joins", () => {
  it("is a further one where there is room", () => {
    expect(handToJoin(setups(1), [client("c1", all)])).toBe(1);
    expect(handToJoin(setups(2), [client("c1", without([1])), client("c2", [1])])).toBe(2);
  });

  it("is the one that somebody has left behind", () => {
    expect(handToJoin(setups(3), [client("c1", without([1])), client("c3", [])])).toBe(1);
  });

  it("is one of whoever steers where there are eight", () => {
    const clients = [client("c1", without([7])), client("c2", [7])];
    expect(handToJoin(setups(8), clients)).toBe(6);
  });

  it("is the second one before the server has told of any", () => {
    expect(handToJoin([], [])).toBe(1);
  });
});

describe("people", () => {
  it("have colours that differ for eight of them in a row", () => {
    const colours = all.map((n) => colourOf(`c${n + 1}`));
    expect(new Set(colours).size).toBe(8);
    expect(colourOf("c9")).toBe(colourOf("c1"));
    expect(colourOf("nobody")).toBe(colourOf("c1"));
  });

  it("are forgotten when they have left, and nobody follows them", () => {
    const store = makeStore();
    store.client.value = "c1";
    noteOthers(store, { event: "looking", client: "c2", eye_m: [0, 0, 1], target_m: [0, 0, 0], p_m: null });
    store.followed.value = "c2";
    noteClients(store, [client("c1", all), client("c2", [])]);
    expect(store.looking.value.size).toBe(1);
    expect(store.followed.value).toBe("c2");
    noteClients(store, [client("c1", all)]);
    expect(store.looking.value.size).toBe(0);
    expect(store.followed.value).toBeNull();
    expect(store.hasLease.value).toBe(true);
  });
});
