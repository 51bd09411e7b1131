// Somebody at the link of a study, without a page: a second picture is too much for a slow machine.
import { EventEmitter, once } from "node:events";
import WebSocket from "ws";
import { kPatienceMs, signIn } from "./harness.mjs";
import { compose, inverse } from "./poses.mjs";

// Kinds of frames, and the size of a credit's item [bytes] (docs/protocol.md).
const kInput = 16;
const kCredit = 17;
const kCreditSize = 4;
const kInputMs = 16;  // between two inputs of a hand that is led
const kStep = 0.002;  // [m] of the hand from one to the next
const kNoFrameMs = 300;  // without a frame, after which it goes on
const kStepsAFrame = 2;  // 30 frames of session time a second
const kHalf = 0.02;  // [m] that a shaft sticks out yet when it is half in

const kHeader = 32;

/** A frame of docs/protocol.md with one item. */
function makeFrame(kind, itemSize) {
  const frame = Buffer.alloc(kHeader + itemSize);
  frame.write("HVAS", 0, "latin1");
  frame.writeUInt16LE(1, 4); // version
  frame.writeUInt16LE(kind, 6);
  frame.writeUInt32LE(frame.length, 8);
  frame.writeUInt32LE(1, 20); // one item
  return frame;
}

/** Says where a hand is; it grips. */
function makeInput({ p, q }) {
  const frame = makeFrame(kInput, 40);
  frame.writeUInt32LE(1, kHeader + 4); // it grips
  [...p, ...q].forEach((v, k) => frame.writeFloatLE(v, kHeader + 8 + 4 * k));
  return frame;
}

/** What a page would send, and what it would be sent. */
export class StudyPeer {
  #socket;
  #answers = new Map();
  #news = new EventEmitter();
  #link;
  #leading = null;
  #hand = null;
  #goal = null;
  state = null;
  heard = [];

  constructor(link) {
    this.#link = link;
    this.#socket = this.#connect(link);
  }

  async #connect(link) {
    const { origin, cookie } = await signIn(link);
    const socket = new WebSocket(`${origin.replace("http", "ws")}/ws`, { origin, headers: { Cookie: cookie } });
    socket.on("message", (data, isBinary) => (isBinary ? this.#acknowledge(socket, data) : this.hear(JSON.parse(data))));
    await once(socket, "open");
    return socket;
  }

  async leave() {
    clearInterval(this.#leading);
    (await this.#socket).terminate();
  }

  #acknowledge(socket, frames) {
    let seq = 0;
    for (let at = 0; at < frames.length; at += frames.readUInt32LE(at + 8)) {
      seq = frames.readUInt32LE(at + 12);
    }
    const credit = makeFrame(kCredit, kCreditSize);
    credit.writeUInt32LE(seq, kHeader);
    socket.send(credit);
    this.#news.emit("frame");
  }

  hear(message) {
    if (message.event !== undefined) {
      this.heard.push(message);
      if (message.event === "study") {
        this.state = message;
        this.#news.emit("study");
      }
      return;
    }
    this.#answers.get(message.id)?.(message);
  }

  do(action, fields = {}) {
    return this.#send({ command: "study", action, ...fields });
  }

  async #send(command) {
    const socket = await this.#socket;
    const id = this.#answers.size + 1;
    const answer = new Promise((resolve) => this.#answers.set(id, resolve));
    socket.send(JSON.stringify({ id, ...command }));
    const { ok, result, error } = await answer;
    if (!ok) {
      throw new Error(`${command.action ?? command.command}: ${error.message}`);
    }
    return result;
  }

  /** Takes a part and puts it half into its place, as a hand does; it is held there. */
  async insertHalf(occurrence) {
    const { origin, cookie } = await signIn(this.#link);
    const scene = await (await fetch(`${origin}/api/scene`, { headers: { Cookie: cookie } })).json();
    const { start, goal } = scene.occurrences[occurrence];
    const { hand } = await this.#send({ command: "take", hand: 0, occurrence });
    this.#hand = hand;
    const socket = await this.#socket;
    // eslint-disable-next-line no-restricted-globals -- A page repeats where its hand is, also while that stands still.
    this.#leading = setInterval(() => socket.send(makeInput(this.#hand)), kInputMs);
    this.#goal = compose(goal, compose(inverse(start), hand));
    const kOver = 0.12;
    await this.#moveTo({ p: [hand.p[0], hand.p[1], this.#goal.p[2] + kOver], q: hand.q });
    await this.#moveTo(this.#over(kOver));
    await this.#moveTo(this.#over(kHalf));
  }

  /** Puts it in wholly; a hand that feels the end presses a little. */
  async insert() {
    await this.#moveTo(this.#over(-0.005));
  }

  #over(height) {
    const { p, q } = this.#goal;
    return { p: [p[0], p[1], p[2] + height], q };
  }

  /** Leads the hand straight to a pose; it turns at the end of the way. It goes by the session's time, of which frames tell:
   on a busy machine it is as slow as the session. */
  async #moveTo({ p, q }) {
    const from = this.#hand.p;
    const steps = Math.max(1, Math.ceil(Math.hypot(...p.map((v, k) => v - from[k])) / kStep));
    for (let n = 1; n <= steps; n++) {
      this.#hand = { p: p.map((v, k) => from[k] + ((v - from[k]) * n) / steps), q: n === steps ? q : this.#hand.q };
      if (n % kStepsAFrame === 0 || n === steps) {
        // Where nothing moves, or the trial is over, none comes.
        await once(this.#news, "frame", { signal: AbortSignal.timeout(kNoFrameMs) }).catch(() => {});
      }
    }
  }

  /** Until the study is so. */
  async until(isSo) {
    const late = AbortSignal.timeout(kPatienceMs);
    while (this.state === null || !isSo(this.state)) {
      await once(this.#news, "study", { signal: late }).catch(() => {
        throw new Error(`not so after ${kPatienceMs} ms: ${isSo}, but ${JSON.stringify(this.state)}`);
      });
    }
    return this.state;
  }
}
