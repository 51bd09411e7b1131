// Somebody at the link of a study, without a page: a second picture is too much for a slow machine.
import { EventEmitter, once } from "node:events";
import WebSocket from "ws";
import { signIn } from "./harness.mjs";

/** What a page would send, and what it would be sent. */
export class StudyPeer {
  #socket;
  #answers = new Map();
  #news = new EventEmitter();
  state = null;
  heard = [];

  constructor(link) {
    this.#socket = this.#connect(link);
  }

  async #connect(link) {
    const { origin, cookie } = await signIn(link);
    const socket = new WebSocket(`${origin.replace("http", "ws")}/ws`, { origin, headers: { Cookie: cookie } });
    socket.on("message", (data, isBinary) => !isBinary && this.hear(JSON.parse(data)));
    await once(socket, "open");
    return socket;
  }

  async leave() {
    (await this.#socket).terminate();
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

  async do(action, fields = {}) {
    const socket = await this.#socket;
    const id = this.#answers.size + 1;
    const answer = new Promise((resolve) => this.#answers.set(id, resolve));
    socket.send(JSON.stringify({ id, command: "study", action, ...fields }));
    const { ok, result, error } = await answer;
    if (!ok) {
      throw new Error(`${action}: ${error.message}`);
    }
    return result;
  }

  /** Until the study is so. */
  async until(isSo, timeout = 60_000) {
    const late = AbortSignal.timeout(timeout);
    while (this.state === null || !isSo(this.state)) {
      await once(this.#news, "study", { signal: late }).catch(() => {
        throw new Error(`not so after ${timeout} ms: ${isSo}, but ${JSON.stringify(this.state)}`);
      });
    }
    return this.state;
  }
}
