import { signal } from "@preact/signals";
import { BoxGeometry, Color, Group, type WebXRManager } from "three";
import { describe, expect, it, vi } from "vitest";
import type { PartPaths, ShownPath } from "../src/model/part_path";
import { makeStore } from "../src/model/store";
import type { Studio } from "../src/model/studio";
import { makeViewState } from "../src/model/view_state";
import { joinPrimitives } from "../src/view3d/part_shape";
import { Viewport } from "../src/view3d/viewport";
import { UserHand } from "../src/view3d/vr/user_hand";
import { begun, installBrowser, memory, type FakeRenderer } from "./fake_browser";
import { toyScene } from "./toy_recording";

vi.mock("three", async (original) => {
  const { FakeRenderer: WebGLRenderer } = await import("./fake_browser");
  return { ...(await original<typeof import("three")>()), WebGLRenderer };
});
vi.mock("../src/view3d/glb", () => ({
  loadShapes: () => {
    const shape = () => joinPrimitives([{ geometry: new BoxGeometry(0.1, 0.1, 0.1), color: new Color(1, 0, 0) }]);
    return Promise.resolve(new Map([0, 1, 2].map((id) => [id, shape()])));
  },
}));

const host = installBrowser();
const kLabels = ["x", "-x", "y", "-y", "z", "-z"] as const;
const onePath = (count: number): ShownPath => ({
  occurrence: 1,
  kind: "points",
  points: { points_m: Array.from({ length: count }, (_, k) => [0.01 * k, 0, 0] as const), poses: [], frames_per_pose: 1 },
  swept: null,
});

/** A view that shows the toy, and all that can be shown beside it. */
async function makeView() {
  const store = makeStore();
  const recordings = { playback: signal(null) };
  const studio = { store, recordings, frames: null, rest: () => {}, noteHands: () => {} };
  const view = makeViewState();
  const port = new Viewport(host, studio as unknown as Studio, view);
  const shown = signal<ShownPath | null>(null);
  port.showPaths({ shown } as unknown as PartPaths);
  port.refreshTheme(kLabels);
  store.live.scene.value = toyScene;
  await vi.waitFor(() => expect(port.product.parts).not.toBeNull());
  const draw = () => {
    port.invalidate();
    (port.renderer as unknown as FakeRenderer).step(performance.now());
  };
  return { port, store, view, shown, draw };
}

/** Marks, measures, cuts and explodes: once with each number, nothing is as it was before. */
function change({ view, shown }: Awaited<ReturnType<typeof makeView>>, k: number): void {
  view.selectedFace.value = { occurrence: k % 3, face: 0 };
  view.picked.value = [{ occurrence: (k + 1) % 3, face: 0 }];
  view.measurement.value = { kind: "plane", text: "", p_m: [[0, 0, 0], [0.01 * (k % 5), 0, 0.01]] };
  view.section.value = { axis: k % 2 ? 0 : 2, offset: 0, isFlipped: false };
  view.explode.value = 0.1 * (1 + (k % 3));
  view.ghosted.value = new Set([0]);
  shown.value = onePath(2 + (k % 4));
}

describe("a view", () => {
  it("ends all that it has begun, and frees all that it was drawn with", async () => {
    for (let round = 0; round < 3; round++) {
      const made = await makeView();
      made.view.showsWorkshop.value = made.view.isFast.value = true;
      await vi.waitFor(() => expect(made.port.workshop.isShown).toBe(true), { timeout: 20_000 });
      change(made, round);
      await Promise.resolve();
      made.draw();
      expect(memory.kept.size).toBeGreaterThan(50);
      expect(begun.size).toBeGreaterThan(10);
      made.port.dispose();
      expect([...memory.kept].map((thing) => (thing as { type?: string }).type)).toEqual([]);
      expect([...begun]).toEqual([]);
    }
  }, 60_000);

  it("follows nothing any more when it has ended", async () => {
    const made = await makeView();
    made.draw();
    made.port.dispose();
    const other = await makeView();  // Where it has followed, the ended one has had the time to.
    for (const each of [made, other]) {
      change(each, 1);
      each.store.live.scene.value = { ...toyScene, epoch: 4 };
      each.view.showsWorkshop.value = each.view.isFast.value = true;
    }
    await vi.waitFor(() => expect(other.port.workshop.isShown).toBe(true), { timeout: 20_000 });
    other.port.dispose();
    made.draw();
    expect(made.port.product.parts).toBeNull();
    expect(memory.kept.size).toBe(0);
  });

  it("keeps no more when the same is shown again and again", async () => {
    const made = await makeView();
    const sizes: number[] = [];
    for (let k = 0; k < 180; k++) {
      change(made, k);
      await Promise.resolve();
      made.draw();
      if (k % 60 === 59) {
        sizes.push(memory.kept.size);
      }
    }
    expect(sizes[1]).toBe(sizes[0]);
    expect(sizes[2]).toBe(sizes[0]);
    made.port.dispose();
  });

  it("keeps nothing of a product when another one is opened", async () => {
    const made = await makeView();
    made.draw();
    const before = memory.kept.size;
    for (let epoch = 10; epoch < 15; epoch++) {
      const parts = made.port.product.parts;
      made.store.live.scene.value = { ...toyScene, epoch, glb: `/api/model/${epoch}.glb` };
      await vi.waitFor(() => expect(made.port.product.parts).not.toBe(parts));
      made.draw();
      expect(memory.kept.size).toBe(before);
    }
    made.port.dispose();
  });
});

describe("a hand in VR", () => {
  it("frees what it is drawn with, and is heard no more", () => {
    const spaces = [new Group(), new Group(), Object.assign(new Group(), { joints: {} })];
    const [grip, ray, hand] = spaces;
    const xr = { getControllerGrip: () => grip, getController: () => ray, getHand: () => hand };
    for (let session = 0; session < 3; session++) {
      const room = new Group();
      const made = new UserHand(0, xr as unknown as WebXRManager, room);
      memory.seeTree(room);
      expect(memory.kept.size).toBe(5);
      made.dispose();
      expect(memory.kept.size).toBe(0);
      expect(room.children).toEqual([]);
      expect((ray as unknown as { _listeners: Record<string, unknown[]> })._listeners["selectstart"]).toEqual([]);
    }
  });
});
