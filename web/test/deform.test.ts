import { BoxGeometry, Color } from "three";
import { describe, expect, it } from "vitest";
import { deformPoint } from "../src/model/deform";
import { FrameStore } from "../src/protocol/frame_store";
import { joinBytes, makeFrame } from "../src/protocol/decoder";
import { DeformationSize, FrameKind, HeaderSize, writeDeformation } from "../src/protocol/frames";
import type { Deformable, Vec3 } from "../src/protocol/messages";
import { FrameCursor, RecordedFrames } from "../src/protocol/recorded_frames";
import { DeformedParts, splitForBending } from "../src/view3d/deformed_parts";
import { findFaceEdges } from "../src/view3d/edges";
import { joinPrimitives } from "../src/view3d/part_shape";
import { Parts } from "../src/view3d/parts";
import { toyScene } from "./toy_recording";

function makeForm(kind: Deformable["kind"], more: Partial<Deformable> = {}): Deformable {
  return {
    occurrence: 1,
    kind,
    origin_m: [0, 0, 0],
    axis: [0, 0, 1],
    aside: [1, 0, 0],
    length_m: 0.02,
    range_m: [-0.01, 0.01],
    across_m: [-0.01, 0.01],
    shares: [1, 1],
    ...more,
  };
}

const kKinds: Deformable["kind"][] = ["bend", "flare", "radial", "open", "press", "cone", "helix", "shift"];

/** The numbers are those of simulation/test/deformation_test.cc. */
describe("what gives", () => {
  it("is as drawn without an amount", () => {
    const p: Vec3 = [0.001, 0.002, 0.003];
    kKinds.forEach((kind) => expect(deformPoint(makeForm(kind), 0, p)).toBe(p));
  });

  it("bends like a cantilever: five sixteenths at the middle, straight on beyond the tip", () => {
    const aside = (z: number) => deformPoint(makeForm("bend"), 0.9e-3, [0, 0, z])[0];
    expect(aside(-1e-3)).toBe(0);
    expect(aside(0)).toBe(0);
    expect(aside(0.01)).toBeCloseTo((0.9e-3 * 5) / 16, 15);
    expect(aside(0.02)).toBeCloseTo(0.9e-3, 15);
    expect(aside(0.022)).toBeCloseTo(1.15 * 0.9e-3, 15);
    expect(deformPoint(makeForm("bend"), 1e-3, [0.011, 0, 0.01])).toEqual([0.011, 0, 0.01]);
  });

  it("flares, widens, opens by 2 pi y, gets shorter, and rises at an edge or an end", () => {
    const [fx, fy] = deformPoint(makeForm("flare", { shares: [-1, 0] }), 1e-3, [0, 0.009, 0.02]);
    expect([fx, fy]).toEqual([0, expect.closeTo(0.008, 15)]);
    const squeezed = makeForm("radial", { range_m: [0.008, 0.01], shares: [0, -1] });
    expect(deformPoint(squeezed, 4e-4, [0.009, 0, 0])[0]).toBeCloseTo(0.0088, 15);
    const ring = makeForm("open", { length_m: 0.009 });
    const end = (165 * Math.PI) / 180;
    const [x, y] = deformPoint(ring, 4e-4, [0.009 * Math.cos(end), 0.009 * Math.sin(end), 0]);
    expect(Math.hypot(x, y)).toBeCloseTo(0.0094, 15);
    const gap = 2 * 0.0094 * (Math.PI - Math.atan2(y, x)) - 2 * 0.009 * (Math.PI - end);
    expect(gap).toBeCloseTo(2 * Math.PI * 4e-4, 12);
    expect(deformPoint(makeForm("press"), -5e-3, [0.004, 0, 0.01])[2]).toBeCloseTo(0.0075, 15);
    const disc = makeForm("cone", { range_m: [0.005, 0.01], shares: [1, 0] });
    expect(deformPoint(disc, 1e-3, [0.0075, 0, 0])[2]).toBeCloseTo(5e-4, 15);
    expect(deformPoint(makeForm("helix"), 1e-3, [0.01, 0, 0])[2]).toBeCloseTo(5e-4, 15);
    expect(deformPoint(makeForm("shift"), 1e-3, [0, 0, 0])).toEqual([0, 0, 1e-3]);
  });
});

/** A bar along z from 0 to 20 mm, 2 mm thick and 4 mm broad. */
function makeBar() {
  const geometry = new BoxGeometry(0.002, 0.004, 0.02).translate(0, 0, 0.01);
  return joinPrimitives([{ geometry, color: new Color(1, 0, 0) }]);
}

describe("the mesh of a part that gives", () => {
  const form = makeForm("bend");

  it("has its edges split where it bends, so that it is closed and near the curve", () => {
    const bar = makeBar();
    const split = splitForBending(bar, [{ index: 0, form }]);
    expect(split.index.length).toBeGreaterThan(4 * bar.index.length);
    expect(split.index.length).toBeLessThan(60 * bar.index.length);
    // Closed: along the border of its six faces there is no edge that only one triangle has.
    const lengths = (shape: typeof bar) => {
      const edges = findFaceEdges(shape.positions, shape.index, new Float32Array(shape.faceIds.length));
      return edges.length;
    };
    expect(lengths(split)).toBe(0);
    expect(splitForBending(bar, [{ index: 0, form: makeForm("press") }]).index.length).toBe(bar.index.length);
  });

  it("follows the frames, and leaves parts alone that share it", () => {
    const bar = makeBar();
    const scene = { ...toyScene, deformables: [makeForm("bend", { occurrence: 0 }), form] };
    const deformed = new DeformedParts(new Map([[0, bar], [1, bar], [2, bar]]), scene);
    const parts = new Parts(deformed.shapes);
    const store = new FrameStore();
    store.ingest(amounts([[1, 1e-3]]), 0);
    expect(deformed.update(store, parts)).toBe(true);
    expect(deformed.update(store, parts)).toBe(false);
    const reach = (id: number) => parts.shapeOf(id)!.box.max.x;
    expect(reach(0)).toBeCloseTo(1e-3, 8);
    expect(reach(1)).toBeCloseTo(2e-3, 8);
    expect(reach(2)).toBeCloseTo(1e-3, 8);
    expect(parts.shapeOf(1)!.drawn).toBe(bar);
    store.ingest(amounts([[1, 0]]), 0);
    expect(deformed.update(store, parts)).toBe(true);
    expect(reach(1)).toBeCloseTo(1e-3, 8);
    expect(deformed.isOf(scene)).toBe(true);
    expect(deformed.isOf(toyScene)).toBe(false);
    parts.dispose();
  });
});

function amounts(items: readonly (readonly [number, number])[], moment = 0): ArrayBuffer {
  const view = makeFrame(FrameKind.Deformations, 3, items.length, DeformationSize, BigInt(moment * 1e7));
  items.forEach(([index, amount_m], k) => writeDeformation(view, HeaderSize + k * DeformationSize, { index, amount_m }));
  return view.buffer as ArrayBuffer;
}

describe("a recording of what gives", () => {
  it("shows the same at a moment from wherever it comes", () => {
    const moments = 300;
    const amountAt = (moment: number) => Math.fround(moment < 140 ? 0 : 1e-3 * Math.sin(moment - 140));
    const pieces = Array.from({ length: moments }, (_, k) =>
      new Uint8Array(amounts(k === 0 ? [[0, 0], [1, 0]] : k >= 140 ? [[1, amountAt(k)]] : [], k)),
    );
    const cursor = new FrameCursor(new RecordedFrames(joinBytes(pieces), 9));
    for (const moment of [299, 10, 150, 130, 280, 0, 141, 256]) {
      cursor.goTo(moment);
      expect(cursor.store.readDeformation(1), `moment ${moment}`).toBe(amountAt(moment));
      expect(cursor.store.readDeformation(0)).toBe(0);
    }
  });
});
