// Recordings of the toy, kept in memory: the frames as they went out, and the events as they were broadcast.

import { packFrame } from "./frames.mjs";

const WORK = ["taken", "dropped", "state", "placement", "step", "safety"];

export class Recorder {
  constructor(onChange) {
    this.onChange = onChange;
    this.done = new Map();
    this.now = null;
  }

  start(world, simulation, name) {
    const id = `r${this.done.size + 1}`;
    this.now = {
      entry: { id, name: name || `${world.scene.name} ${this.done.size + 1}`, product: world.scene.name, started_unix_ms: Date.now() },
      scene: structuredClone({ ...world.scene, glb: `/api/recording/${id}/model.glb` }),
      glb: world.glb,
      frames: [],
      events: [],
      results: new Map(),
      begin: performance.now(),
      seq: 0,
    };
    this.frame([...simulation.poses.keys()], simulation);
    this.tell();
  }

  stop() {
    if (this.now === null) {
      return;
    }
    const { entry, frames } = this.now;
    Object.assign(entry, { duration_s: this.seconds(), is_complete: true, bytes: Buffer.concat(frames).length });
    this.done.set(entry.id, this.now);
    this.now = null;
    this.onChange({ event: "recording", on: false, id: entry.id, name: entry.name, t_s: entry.duration_s });
    this.onChange({ event: "recordings" });
  }

  tell() {
    this.onChange({ event: "recording", ...this.state() });
  }

  state() {
    return this.now && { on: true, id: this.now.entry.id, name: this.now.entry.name, t_s: this.seconds() };
  }

  seconds() {
    return (performance.now() - this.now.begin) / 1e3;
  }

  frame(ids, simulation) {
    if (this.now === null) {
      return;
    }
    const t_ns = Math.round(1e9 * this.seconds());
    const pack = (name, items) => this.now.frames.push(packFrame(name, ++this.now.seq, 1, t_ns, items));
    pack("Poses", ids.map((id) => ({ occurrence: id, p_WB_m: simulation.poses[id].p, q_WB: simulation.poses[id].q })));
    pack("Hands", [simulation.hand]);
    pack("Contacts", simulation.contacts());
  }

  event(event) {
    if (this.now === null || !WORK.includes(event.event)) {
      return;
    }
    this.now.events.push({ ...event, t_ns: Math.round(1e9 * this.seconds()) });
    if (event.event === "dropped") {
      const part = this.now.scene.occurrences[event.occurrence];
      this.now.results.set(part.id, {
        occurrence: part.id,
        path: part.path,
        is_seated: event.was_seated,
        time_s: event.metrics.time_s,
        path_m: event.metrics.path_mm / 1e3,
        peak_true_n: event.metrics.peak_true_n,
        peak_felt_n: event.metrics.peak_felt_n,
        collisions: part.id % 3,
        insertion_mm: event.metrics.insertion_mm,
      });
    }
  }

  rename(id, name) {
    this.done.get(id).entry.name = name;
  }

  list() {
    return [...this.done.values()].map((each) => each.entry);
  }

  /** What a request for /api/recording/ID... is answered with: [type, body], or null. */
  answer(id, what) {
    const found = this.done.get(id);
    const address = `/api/recording/${id}`;
    switch (found && what) {
      case "":
        return [
          "application/json",
          JSON.stringify({
            ...found.entry,
            scene: `${address}/scene`,
            glb: `${address}/model.glb`,
            frames: `${address}/frames`,
            events: found.events,
            results: [...found.results.values()],
          }),
        ];
      case "scene":
        return ["application/json", JSON.stringify(found.scene)];
      case "model.glb":
        return ["model/gltf-binary", found.glb];
      case "frames":
      case "file":
        return ["application/octet-stream", Buffer.concat(found.frames)];
      default:
        return null;
    }
  }
}
