// A stand-in for the studio's server, to work on the page without it:
//   npm run build && npm run mock -- --hvas ../build/release/src/app/hvas --file ../products/gear_pump.step
//   ... --study   a tiny study in place of the studio. SIGUSR1: somebody puts the part half in, and wholly at the next one.
//                 SIGUSR2: all connections are lost, until the next one.
// It has the routes, headers and messages of docs/protocol.md, and a toy in place of the simulation.

import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { WebSocketServer } from "ws";
import { packFrame, unpackFrame } from "./frames.mjs";
import { Hands, rates } from "./hands.mjs";
import { Recorder } from "./recorder.mjs";
import { makeScene } from "./scene.mjs";
import { Simulation } from "./simulation.mjs";
import { eventFor, handFor, MockStudy, sceneFor } from "./study.mjs";

const { values: options } = parseArgs({
  options: {
    port: { type: "string", default: "8600" },
    hvas: { type: "string", default: "../build/release/src/app/hvas" },
    file: { type: "string" },
    study: { type: "boolean", default: false },
    example: { type: "string", default: "../products/gear_pump.step" },
    dist: { type: "string", default: fileURLToPath(new URL("../dist", import.meta.url)) },
  },
});

const TOKENS = { mock: "operator", viewer: "viewer", participant: "participant" };
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const HEADERS = {
  "Content-Security-Policy":
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' data: blob:; " +
    "connect-src 'self'; worker-src 'self'; font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
  "Cross-Origin-Opener-Policy": "same-origin",
  "Cross-Origin-Embedder-Policy": "require-corp",
  "X-Content-Type-Options": "nosniff",
  "Referrer-Policy": "no-referrer",
};
const EXAMPLES = [
  { id: "gear_pump", name: "Gear pump", about: "38 parts with press fits, bolts and pins", is_recent: false },
  { id: "bushing", name: "Bushing rig", about: "Shaft, bushing and chuck: the fits of the paper", is_recent: false },
  { id: "frame_500", name: "Frame of 500", about: "A large frame, to see how far it goes", is_recent: false },
];

let world = null;
let simulation = null;
let epoch = 0;
let forcesOff = false;
let seq = 0;
let nextClient = 1;
const clients = new Map();

let study = null;
let isCut = false;

/** Without a study everybody is an operator. */
function roleOf(request) {
  const token = /hvas=(\w+)/.exec(request.headers.cookie ?? "")?.[1];
  return study === null ? "operator" : TOKENS[token];
}

function send(client, event) {
  const told = eventFor(client.role, event);
  if (told !== null) {
    client.socket.send(JSON.stringify(told));
  }
}

const broadcast = (event) => {
  recorder.event(event);
  clients.forEach((client) => send(client, event));
  study?.noteHold(event);
};
const recorder = new Recorder(broadcast);
const hands = new Hands(broadcast);

function open(file) {
  epoch += 1;
  world = makeScene(options.hvas, file, epoch);
  simulation = new Simulation(world.scene, broadcast);
  clients.forEach((client) => (client.knows = 0));
  broadcast({ event: "scene", epoch, why: null });
  simulation.nextStep();
}

const PART = 2;
const LAY_OUT_MS = 500;
let isHalting = false;

/** All parts but one are in their places. */
function layOut() {
  epoch += 1;
  world.scene.epoch = epoch;
  world.scene.occurrences.forEach((o) => (o.placement = o.id === PART ? "loose" : "placed"));
  simulation = new Simulation(world.scene, (event) => event.event !== "demo" && broadcast(event));
  simulation.poses = world.scene.occurrences.map((o) => (o.id === PART ? o.start : o.goal));
  clients.forEach((client) => (client.knows = 0));
  broadcast({ event: "scene", epoch, why: null });
  simulation.nextStep();
}

const bench = {
  timers: [],
  later(ms, what) {
    this.timers.push(setTimeout(what, ms));
  },
  begin() {
    this.end();
    this.later(LAY_OUT_MS, () => {
      layOut();
      study.began();
    });
  },
  end() {
    this.timers.splice(0).forEach(clearTimeout);
    if (simulation !== null) {
      simulation.demo = null;
    }
  },
};

function startStudy() {
  const onChange = () => clients.forEach((client) => send(client, study.state(client.role)));
  study = new MockStudy({ onChange, bench, occurrence: PART, link: "/#t=participant" });
  layOut();
  setInterval(() => study.isTask && onChange(), 1000);
}

function reply(response, status, body, type = "application/json") {
  response.writeHead(status, { ...HEADERS, "Content-Type": type });
  response.end(body);
}

const server = createServer((request, response) => {
  const { pathname } = new URL(request.url, "http://localhost");
  if (pathname === "/api/session") {
    admit(request, response);
  } else if (pathname === "/api/scene") {
    reply(response, world ? 200 : 404, JSON.stringify(world ? sceneFor(roleOf(request), world.scene) : {}));
  } else if (pathname.startsWith("/api/model/")) {
    reply(response, world ? 200 : 404, world?.glb ?? "", "model/gltf-binary");
  } else if (pathname === "/api/recordings") {
    reply(response, 200, JSON.stringify({ recordings: recorder.list() }));
  } else if (pathname.startsWith("/api/recording/")) {
    const [id, what = ""] = pathname.slice("/api/recording/".length).split("/");
    const found = recorder.answer(id, what);
    const error = { code: "not_found", message: `There is no recording ${id}.`, where: id, remedy: "Choose another one." };
    reply(response, found ? 200 : 404, found?.[1] ?? JSON.stringify({ error }), found?.[0]);
  } else if (pathname === "/api/link") {
    const link = { token: "viewer", role: "viewer", is_for_one: false, is_local: false, reachable: [] };
    request.resume().on("end", () => reply(response, 200, JSON.stringify({ ...link, origins: [`http://${request.headers.host}`] })));
  } else if (pathname === "/api/upload") {
    request.resume().on("end", () => reply(response, 200, JSON.stringify({ upload: "1" })));
  } else {
    sendFile(response, pathname === "/" ? "/index.html" : pathname);
  }
});

function admit(request, response) {
  let body = "";
  request.on("data", (bytes) => (body += bytes));
  request.on("end", () => {
    const { token } = JSON.parse(body);
    const isKnown = Object.hasOwn(TOKENS, token);
    if (isKnown) {
      response.setHeader("Set-Cookie", `hvas=${token}; HttpOnly; SameSite=Strict; Path=/`);
    }
    reply(response, isKnown ? 200 : 403, JSON.stringify({ role: study === null ? "operator" : TOKENS[token] }));
  });
}

function sendFile(response, pathname) {
  try {
    const path = join(options.dist, normalize(pathname));
    reply(response, 200, readFileSync(path), TYPES[extname(path)] ?? "application/octet-stream");
  } catch {
    reply(response, 404, JSON.stringify({ error: { code: "not_found", message: pathname, where: "", remedy: "" } }));
  }
}

const lease = () => [...clients].find(([, client]) => client.role === (study === null ? "operator" : "participant"))?.[0];
const roles = () => [...clients].map(([id, { role }]) => ({ id, name: "", role, has_lease: id === lease(), hands: id === lease() ? [0, 1] : [] }));

/** From where it lies, up, across and down into its place. */
function makePath({ start, goal }) {
  const high = Math.max(start.p[2], goal.p[2]) + 0.08;
  const corners = [start.p, [start.p[0], start.p[1], high], [goal.p[0], goal.p[1], high], goal.p];
  const points_m = Array.from({ length: 61 }, (_, k) => {
    const [from, to] = [corners[Math.min(2, Math.floor(k / 20))], corners[Math.min(3, Math.floor(k / 20) + 1)]];
    const share = k === 60 ? 1 : (k % 20) / 20;
    return from.map((v, axis) => v + share * (to[axis] - v));
  });
  return { points_m, poses: points_m.map((p, k) => ({ p, q: k < 20 ? start.q : goal.q })) };
}

const commands = {
  async open({ example }) {
    const file = example ? options.example.replace("gear_pump", example) : options.example;
    for (const [k, stage] of ["read", "heal", "mesh", "shapes", "mates", "sequence"].entries()) {
      broadcast({ event: "progress", stage, fraction: k / 6, file });
      await new Promise((done) => setTimeout(done, 150));
    }
    open(file);
  },
  take: ({ occurrence }) => ({ hand: simulation.take(occurrence), occurrence, members: [], way_in: [0, 0, -1], table_places: [] }),
  release: () => simulation.release(),
  forces({ off }) {
    forcesOff = off;
    simulation?.stopDemo();
    broadcast({ event: "forces", off, by: lease() ?? "" });
  },
  demo: ({ on }) => (on ? simulation.startDemo(true) : simulation.stopDemo()),
  next: () => simulation.startDemo(false),
  hands: ({ count }) => hands.setCount(count),
  devices: () => hands.search(),
  use: ({ hand, device, scale }) => hands.use(hand, device, scale),
  record: ({ on, name }) => (on ? recorder.start(world, simulation, name) : recorder.stop()),
  rename_recording({ recording: id, name }) {
    recorder.rename(id, name);
    broadcast({ event: "recordings" });
  },
  delete_recording({ recording: id }) {
    recorder.done.delete(id);
    broadcast({ event: "recordings" });
  },
  path: ({ occurrence, as }) =>
    as === "swept"
      ? { glb: world.scene.glb, volume_mm3: 51_200, error_mm: 0.2 }
      : makePath(world.scene.occurrences[occurrence]),
  measure: ({ a, b }) => ({
    kind: b ? "distance" : "face",
    distance_mm: b ? 42.125 : null,
    angle_deg: b ? 0 : null,
    radius_mm: b ? null : 13,
    area_mm2: b ? null : 1388.6,
    text: b ? "parallel" : "cylinder",
    p_m: b ? [simulation.poses[a.occurrence].p, simulation.poses[b.occurrence].p] : [simulation.poses[a.occurrence].p],
  }),
};

new WebSocketServer({ server, path: "/ws" }).on("connection", (socket, upgrade) => {
  const role = roleOf(upgrade);
  if (role === undefined || isCut) {
    socket.close();
    return;
  }
  const id = `c${nextClient++}`;
  const client = { socket, role, pending: 0, knows: 0 };
  clients.set(id, client);
  const hello = { event: "hello", version: 1, role, client: id, has_lease: id === lease() };
  socket.send(JSON.stringify({ ...hello, examples: EXAMPLES, forces_off: forcesOff, has_scene: world !== null, hands: hands.list(), recording: recorder.state(), has_study: study !== null, demo: Boolean(simulation?.demo) }));
  broadcast({ event: "roles", clients: roles() });
  if (study !== null) {
    send(client, study.state(role));
  }
  broadcast({ event: "history", undo: null, redo: null, forgotten: 0 });
  simulation?.nextStep();
  socket.on("message", async (data, isBinary) => {
    if (isBinary) {
      const { name, items } = unpackFrame(data);
      if (name === "Credit") {
        client.pending = Math.max(0, client.pending - 1);
      } else if (simulation && !simulation.demo) {
        simulation.input = items[0];
      }
      return;
    }
    const { id: request, command, ...fields } = JSON.parse(data);
    if (command === "study") {
      const answer = study?.do(role, fields) ?? { error: { code: "invalid", message: "no study runs", where: "", remedy: "" } };
      socket.send(JSON.stringify({ id: request, ok: answer.error === undefined, ...answer }));
      return;
    }
    const result = (await commands[command]?.(fields)) ?? {};
    socket.send(JSON.stringify({ id: request, ok: true, result }));
  });
  socket.on("close", () => {
    clients.delete(id);
    broadcast({ event: "roles", clients: roles() });
  });
});

function publish() {
  simulation?.tick();
  if (simulation !== null) {
    recorder.frame([...simulation.moved], simulation);
  }
  for (const client of clients.values()) {
    if (simulation === null || client.pending >= 2) {
      continue;
    }
    const ids = client.knows === epoch ? [...simulation.moved] : simulation.poses.keys();
    client.knows = epoch;
    const t_ns = Math.round(performance.now() * 1e6);
    const poses = [...ids].map((id) => ({ occurrence: id, p_WB_m: simulation.poses[id].p, q_WB: simulation.poses[id].q }));
    const pack = (name, items) => packFrame(name, ++seq, epoch, t_ns, items);
    client.pending += 1;
    client.socket.send(
      Buffer.concat([pack("Poses", poses), pack("Hands", [handFor(client.role, simulation.hand)]), pack("Contacts", simulation.contacts())]),
    );
  }
  simulation?.moved.clear();
}

setInterval(publish, 1000 / 60);
setInterval(
  () =>
    broadcast({
      event: "status",
      tick_hz: 1000,
      compute_p50_us: 45,
      compute_p99_us: 63,
      compute_max_us: 120,
      wake_up_p99_us: 90,
      scheduling: "SCHED_FIFO",
      physics_hz: 100,
      late_ticks: 0,
      overruns: 0,
      is_memory_locked: true,
      lost_events: 0,
      truncated_ticks: 0,
      crowded_ticks: 0,
      clients: clients.size,
      effort_level: 0,
      ...rates(simulation?.hand),
    }),
  1000,
);
// Somebody puts the part half in; and then goes on.
process.on("SIGUSR1", () => {
  isHalting = study?.isTask === true && !simulation.demo;
  if (isHalting) {
    simulation.startDemo(false, () => isHalting);
  }
});
// As a network does that breaks down; and then works again.
process.on("SIGUSR2", () => {
  isCut = !isCut;
  if (isCut) {
    clients.forEach((client) => client.socket.terminate());
  }
});
if (options.file) {
  open(options.file);
}
if (options.study) {
  startStudy();
}
server.listen(Number(options.port), "127.0.0.1", () => {
  const origin = `http://127.0.0.1:${server.address().port}`;
  const tokens = options.study ? Object.keys(TOKENS) : ["mock"];
  console.log(tokens.map((token) => `${origin}/#t=${token}`).join("\n"));
});
