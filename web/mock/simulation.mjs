// A hand that is just good enough to try the page with: a spring, an axis that captures, a seat.

import { NONE } from "./frames.mjs";

const rotate = ([w, x, y, z], v) => {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [
    v[0] + w * t[0] + y * t[2] - z * t[1],
    v[1] + w * t[1] + z * t[0] - x * t[2],
    v[2] + w * t[2] + x * t[1] - y * t[0],
  ];
};
const add = (a, b) => a.map((v, k) => v + b[k]);
const sub = (a, b) => a.map((v, k) => v - b[k]);
const times = (a, s) => a.map((v) => v * s);
const dot = (a, b) => a.reduce((n, v, k) => n + v * b[k], 0);
const norm = (a) => Math.hypot(...a);
const angle = (a, b) => 2 * Math.acos(Math.min(1, Math.abs(a.reduce((n, v, k) => n + v * b[k], 0))));

const FREE = 1, NEAR = 2, CAPTURED = 3, MATING = 4, SEATED = 5;
const PERIOD = 1 / 60;
/** Of the scripted person: corners of the way a second. */
const PACE = 1.4;

export class Simulation {
  constructor(scene, onEvent) {
    this.scene = scene;
    this.onEvent = onEvent;
    this.poses = scene.occurrences.map((o) => (o.is_base ? o.goal : o.start));
    this.placements = scene.occurrences.map((o) => o.placement);
    this.moved = new Set(scene.occurrences.map((o) => o.id));
    this.step = 1;
    this.held = null;
    this.state = 0;
    this.demo = null;
    this.input = null;
    this.hand = this.emptyHand();
  }

  get expected() {
    return this.scene.steps[this.step]?.occurrence ?? null;
  }

  emptyHand() {
    return { hand: 0, occurrence: NONE, mate: NONE, q_WH: [1, 0, 0, 0], q_WT: [1, 0, 0, 0], q_WD: [1, 0, 0, 0] };
  }

  take(id) {
    const part = this.scene.occurrences[id];
    const pose = this.poses[id];
    const hand = { p: add(pose.p, rotate(pose.q, part.p_BoBcm_m)), q: pose.q };
    this.held = { id, part, display: { ...pose }, start: Date.now(), path: 0, peak: 0 };
    this.input = { p_WH_m: hand.p, q_WH: hand.q };
    this.place(id, "held");
    this.setState(FREE);
    this.onEvent({ event: "taken", hand: 0, occurrence: id, state: 1 });
    return hand;
  }

  release() {
    if (this.held === null) {
      return;
    }
    const { id, part, start, path, peak } = this.held;
    const wasSeated = this.state === SEATED;
    this.poses[id] = wasSeated ? part.goal : { p: [...this.held.display.p.slice(0, 2), part.start.p[2]], q: part.start.q };
    this.moved.add(id);
    this.held = null;
    this.hand = this.emptyHand();
    this.place(id, wasSeated ? "placed" : "loose");
    this.onEvent({
      event: "dropped",
      hand: 0,
      occurrence: id,
      state: 0,
      was_seated: wasSeated,
      to_place_mm: wasSeated ? 0 : 20,
      metrics: {
        time_s: (Date.now() - start) / 1e3,
        path_mm: 1e3 * path,
        peak_true_n: 1.4 * peak,
        peak_felt_n: peak,
        fit_true_n: 0.6 * peak,
        depth_um: 12,
        insertion_mm: wasSeated ? 1e3 * this.length : 0,
        collisions: 0,
      },
    });
    this.state = 0;
    if (wasSeated) {
      this.nextStep();
    }
  }

  nextStep() {
    while (this.expected !== null && this.placements[this.expected] === "placed") {
      this.step += 1;
    }
    this.scene.next_step = this.step;
    this.onEvent({ event: "step", index: this.step, total: this.scene.steps.length });
  }

  place(id, placement) {
    this.placements[id] = placement;
    this.scene.occurrences[id].placement = placement;
    this.onEvent({ event: "placement", occurrence: id, placement });
  }

  setState(state) {
    if (state !== this.state) {
      this.state = state;
      this.onEvent({ event: "state", hand: 0, occurrence: this.held.id, state });
    }
  }

  get length() {
    return this.scene.steps.find((s) => s.occurrence === this.held?.id)?.distance_m * 0.5 || 0.03;
  }

  tick() {
    this.demo?.(this);
    if (this.held === null) {
      return;
    }
    const { part } = this.held;
    const q = this.input.q_WH;
    const tracked = { p: sub(this.input.p_WH_m, rotate(q, part.p_BoBcm_m)), q };
    const out = [0, 0, 1];
    const off = sub(tracked.p, part.goal.p);
    const height = dot(off, out);
    const side = norm(sub(off, times(out, height)));
    const tilt = angle(q, part.goal.q);
    this.decide(side, height, tilt);
    const wanted = this.constrain(tracked, height);
    const before = this.held.display;
    this.held.display = { p: add(before.p, times(sub(wanted.p, before.p), 0.4)), q: wanted.q };
    this.held.path += norm(sub(this.held.display.p, before.p));
    this.poses[this.held.id] = this.held.display;
    this.moved.add(this.held.id);
    this.describe(tracked, height, tilt, side);
  }

  decide(side, height, tilt) {
    const reach = 0.35 * this.length;
    if (this.state === SEATED) {
      return;
    }
    if (this.state >= CAPTURED && side < 3 * reach) {
      this.setState(height < 0.0005 ? SEATED : height < this.length ? MATING : CAPTURED);
    } else if (side < reach && tilt < 0.2 && height < 2 * this.length && height > -0.01) {
      this.setState(CAPTURED);
    } else {
      this.setState(side < 3 * reach && height < 3 * this.length ? NEAR : FREE);
    }
  }

  constrain(tracked, height) {
    const { goal } = this.held.part;
    if (this.state === SEATED) {
      return goal;
    }
    if (this.state >= CAPTURED) {
      const lag = this.state === MATING ? 0.002 : 0;
      return { p: add(goal.p, [0, 0, Math.max(0, height + lag)]), q: goal.q };
    }
    return { p: [tracked.p[0], tracked.p[1], Math.max(tracked.p[2], this.held.part.start.p[2])], q: tracked.q };
  }

  describe(tracked, height, tilt, side) {
    const { display, part } = this.held;
    const pull = times(sub(display.p, tracked.p), 700);
    const felt = norm(pull) > 8 ? times(pull, 8 / norm(pull)) : pull;
    this.held.peak = Math.max(this.held.peak, norm(felt));
    const mate = this.scene.mates.find((m) => m.kind === "axis_hole" && (m.a === part.id || m.b === part.id));
    this.hand = {
      hand: 0,
      state: this.state,
      occurrence: part.id,
      mate: this.state >= NEAR && mate ? mate.id : NONE,
      contact_count: this.state === MATING ? 4 : 0,
      p_WH_m: this.input.p_WH_m,
      q_WH: this.input.q_WH,
      p_WT_m: tracked.p,
      q_WT: tracked.q,
      p_WD_m: display.p,
      q_WD: display.q,
      f_felt_W_n: felt,
      t_felt_W_nm: times([felt[1], -felt[0], 0], 0.02),
      f_true_W_n: times(felt, 1.6),
      t_true_W_nm: times([felt[1], -felt[0], 0], 0.03),
      peak_felt_n: norm(felt),
      axial_true_n: Math.abs(1.6 * felt[2]),
      axial_felt_n: Math.abs(felt[2]),
      depth_m: this.state >= CAPTURED ? Math.max(0, this.length - Math.max(0, height)) : 0,
      depth_goal_m: this.length,
      tilt_rad: tilt,
      offset_m: side,
      p_WAxis_m: part.goal.p,
      axis_W: this.state >= NEAR ? [0, 0, 1] : [0, 0, 0],
    };
  }

  contacts() {
    if (this.held === null || this.state !== MATING) {
      return [];
    }
    const { p } = this.held.display;
    return [0, 1, 2, 3].map((k) => ({
      hand: 0,
      occurrence: 0,
      p_WC_m: add(p, [0.008 * Math.cos(k * 1.57), 0.008 * Math.sin(k * 1.57), 0]),
      f_C_W_n: [0.5, 0.5, 0.2 * k],
    }));
  }

  /** A scripted person: lifts the expected part, carries it over its place and lowers it.
   @param isHalting  Asked when the part is half in: whether they stop there for now. */
  startDemo(isEndless, isHalting = () => false) {
    let phase = 0;
    let t = 0;
    let from = null;
    this.demo = () => {
      if (this.state === MATING && this.hand.depth_m > 0.5 * this.length && isHalting()) {
        return;
      }
      t += PERIOD;
      if (phase === 0) {
        if (this.expected === null) {
          this.stopDemo();
          return;
        }
        from = this.take(this.expected);
        phase = 1;
        t = 0;
      } else if (this.state === SEATED && t > 0.4) {
        this.release();
        phase = 0;
        if (!isEndless) {
          this.stopDemo();
        }
      } else if (this.held !== null) {
        const goal = add(this.held.part.goal.p, rotate(this.held.part.goal.q, this.held.part.p_BoBcm_m));
        const high = Math.max(from.p[2], goal[2]) + 2 * this.length;
        const path = [from.p, [from.p[0], from.p[1], high], [goal[0], goal[1], high], add(goal, [0, 0, -0.004])];
        const s = Math.min(2.999, t * PACE);
        const k = Math.floor(s);
        this.input = { p_WH_m: add(path[k], times(sub(path[k + 1], path[k]), s - k)), q_WH: this.held.part.goal.q };
        if (this.state !== SEATED) {
          return;
        }
        t = Math.min(t, 0.39);
        t += PERIOD;
      }
    };
    this.onEvent({ event: "demo", on: true });
  }

  stopDemo() {
    this.demo = null;
    this.onEvent({ event: "demo", on: false });
  }
}
