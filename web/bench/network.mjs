// Eight clients over a link with delay and loss (bench/lossy_link.py): `npm run network [-- FILE [DELAY_MS [LOSS]]]` with
// the program in HVAS_BINARY, as root. One client leads a hand that presses a part onto the table and moves it to and
// fro; all of them get the frames and draw nothing. Told: the age of the newest state as a picture would show it, bytes
// a second, processor time of the server, the largest force and its largest change from frame to frame, and what the
// safety gate did. Figures are for docs/studio.md.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import WebSocket from "ws";
import { signIn, startStudio } from "../e2e/harness.mjs";
import { quantile } from "./quantile.mjs";

const kClients = 8;
const kSeconds = 30;
const kPictureMs = 1000 / 60;
const kNamespace = "hvas-bench";
const kAddress = "10.99.0.1";
const kHeader = 32;
const kPressM = 0.004;
const kSwingM = 0.02;
const kSwingHz = 0.5;
const kPerSecond = 100; // Ticks of the processor's clock, of /proc.

const [file = "../products/frame_500.step", delayMs = "50", loss = "0.01"] = process.argv.slice(2);

/** In the namespace: one client. Its argument says where to and with what cookie. */
async function runClient({ url, origin, cookie, leads }) {
  const socket = new WebSocket(url, { origin, headers: { Cookie: cookie }, rejectUnauthorized: false });
  const ages = [];
  const forces = [];
  const safety = [];
  let bytes = 0;
  let newestNs = null;
  let pose = null;
  let seq = 0;
  socket.on("message", (data, isBinary) => {
    bytes += data.length;
    if (!isBinary) {
      const message = JSON.parse(data.toString());
      if (message.event === "safety") {
        safety.push(message.reasons.join(", "));
      }
      if (message.id === 1 && message.ok) {
        pose = message.result.hand;
      }
      return;
    }
    for (let at = 0; at < data.length; at += data.readUInt32LE(at + 8)) {
      newestNs = data.readBigInt64LE(at + 24);
      if (leads && data.readUInt16LE(at + 6) === 2) {
        // f_felt_W_n of hand 0: after six words and three poses.
        const from = at + kHeader + 24 + 3 * 28;
        forces.push([0, 1, 2].map((k) => data.readFloatLE(from + 4 * k)));
      }
      seq = data.readUInt32LE(at + 12);
    }
    const credit = Buffer.alloc(kHeader + 4);
    credit.write("HVAS", 0, "latin1");
    credit.writeUInt16LE(1, 4);
    credit.writeUInt16LE(17, 6);
    credit.writeUInt32LE(credit.length, 8);
    credit.writeUInt32LE(1, 20);
    credit.writeUInt32LE(seq, kHeader);
    socket.send(credit);
  });
  await once(socket, "open");
  if (leads) {
    socket.send(JSON.stringify({ id: 1, command: "take", hand: 0, occurrence: leads.occurrence }));
  }
  const begun = performance.now();
  let before = 0;
  const timer = setInterval(() => {
    if (newestNs !== null && performance.now() - begun > 5000) {
      before ||= bytes;
      ages.push(Number(process.hrtime.bigint() - newestNs) / 1e6);
    }
    if (pose !== null) {
      const t = (performance.now() - begun) / 1000;
      const frame = Buffer.alloc(kHeader + 40);
      frame.write("HVAS", 0, "latin1");
      frame.writeUInt16LE(1, 4);
      frame.writeUInt16LE(16, 6);
      frame.writeUInt32LE(frame.length, 8);
      frame.writeUInt32LE(1, 20);
      frame.writeUInt32LE(1, kHeader + 4);
      const p = [pose.p[0] + kSwingM * Math.sin(2 * Math.PI * kSwingHz * t), pose.p[1], pose.p[2] - kPressM];
      [...p, ...pose.q].forEach((v, k) => frame.writeFloatLE(v, kHeader + 8 + 4 * k));
      socket.send(frame);
    }
  }, kPictureMs);
  await new Promise((resolve) => setTimeout(resolve, (kSeconds + 5) * 1000));
  clearInterval(timer);
  socket.terminate();
  const sizes = forces.map((f) => Math.hypot(...f));
  const changes = forces.slice(1).map((f, i) => Math.hypot(...f.map((v, k) => v - forces[i][k])));
  console.log(JSON.stringify({ ages, bytesPerSecond: (bytes - before) / kSeconds, safety, force: Math.max(0, ...sizes), change: Math.max(0, ...changes) }));
}

function processorSeconds(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / kPerSecond;
}

async function main() {
  const link = spawn("python3", ["bench/lossy_link.py", kNamespace, "--delay-ms", delayMs, "--loss", loss], { stdio: ["pipe", "pipe", "inherit"] });
  await once(link.stdout, "data");
  process.env["NODE_TLS_REJECT_UNAUTHORIZED"] = "0";
  const studio = await startStudio([file, "--listen", kAddress, "--fresh"], { clock: "machine" });
  try {
    const host = await signIn(studio.operator);
    const viewer = await signIn(studio.viewer);
    const scene = await waitForScene(studio, host.cookie);
    const part = scene.steps.find(({ kind }) => kind === "insert").occurrence;
    const url = `${studio.origin.replace("http", "ws")}/ws`;
    const runs = Array.from({ length: kClients }, (_, n) => {
      const who = { url, origin: studio.origin, cookie: n === 0 ? host.cookie : viewer.cookie, leads: n === 0 ? { occurrence: part } : null };
      return runInNamespace(who);
    });
    const before = processorSeconds(studio.pid);
    const results = await Promise.all(runs);
    const used = processorSeconds(studio.pid) - before;
    tell(results, used);
  } finally {
    await studio.stop();
    link.stdin.end();
    await once(link, "exit");
  }
}

async function waitForScene(studio, cookie) {
  for (;;) {
    const answer = await fetch(`${studio.origin}/api/scene`, { headers: { Cookie: cookie } });
    const scene = answer.ok ? await answer.json() : null;
    if (scene !== null && scene.pending === 0) {
      return scene;
    }
    await new Promise((resolve) => setTimeout(resolve, 500));
  }
}

async function runInNamespace(who) {
  const child = spawn("ip", ["netns", "exec", kNamespace, process.execPath, fileURLToPath(import.meta.url), "--client", JSON.stringify(who)], {
    stdio: ["ignore", "pipe", "inherit"],
    env: { ...process.env, NODE_NO_WARNINGS: "1" },
  });
  let text = "";
  child.stdout.on("data", (data) => (text += data));
  await once(child, "exit");
  return JSON.parse(text);
}

function tell(results, used) {
  const ages = results.flatMap((result) => result.ages);
  const worst = results.map((result) => quantile(result.ages, 0.99));
  const [leader] = results;
  console.log(`${kClients} clients, ${delayMs} ms each way, ${100 * Number(loss)} % loss, ${kSeconds} s of ${file}`);
  console.log(`age of the newest state, p50 / p99 / p99 of the worst client: ${[quantile(ages, 0.5), quantile(ages, 0.99), Math.max(...worst)].map((ms) => ms.toFixed(0)).join(" / ")} ms`);
  console.log(`bytes a second and client: ${Math.round(Math.max(...results.map((result) => result.bytesPerSecond)))} at most`);
  console.log(`processor time of the server: ${((100 * used) / (kSeconds + 5)).toFixed(0)} % of one core`);
  console.log(`force felt: ${leader.force.toFixed(2)} N at most, ${leader.change.toFixed(2)} N from frame to frame at most; safety gate: ${leader.safety.length === 0 ? "nothing" : leader.safety.join("; ")}`);
}

const at = process.argv.indexOf("--client");
await (at < 0 ? main() : runClient(JSON.parse(process.argv[at + 1])));
