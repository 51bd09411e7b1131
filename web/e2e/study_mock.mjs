// The mock server with a tiny study, for a test: its links, somebody at the other end, and how to end it.
import { spawn } from "node:child_process";
import { once } from "node:events";
import WebSocket from "ws";

const kProgram = process.env["HVAS_BINARY"] ?? "../build/dev/src/app/hvas";
const kPage = process.env["HVAS_PAGE"] ?? "../build/web/dist";

/** Somebody at another link, without a page: what a page would send, and what it would be sent. */
class Other {
  constructor(link) {
    const { host, hash } = new URL(link);
    this.socket = new WebSocket(`ws://${host}/ws`, { headers: { Cookie: `hvas=${hash.slice("#t=".length)}` } });
    this.state = null;
    this.heard = [];
    this.answers = new Map();
    this.socket.on("message", (data, isBinary) => !isBinary && this.hear(JSON.parse(data)));
  }

  hear(message) {
    if (message.event !== undefined) {
      this.heard.push(message);
      this.state = message.event === "study" ? message : this.state;
      return;
    }
    this.answers.get(message.id)?.(message);
  }

  async do(action, fields = {}) {
    if (this.socket.readyState !== WebSocket.OPEN) {
      await once(this.socket, "open");
    }
    const id = this.answers.size + 1;
    const answer = new Promise((resolve) => this.answers.set(id, resolve));
    this.socket.send(JSON.stringify({ id, command: "study", action, ...fields }));
    const { ok, result, error } = await answer;
    if (!ok) {
      throw new Error(`${action}: ${error.message}`);
    }
    return result;
  }

  /** Until the study is so. */
  async until(isSo, timeout = 60_000) {
    const end = Date.now() + timeout;
    while (this.state === null || !isSo(this.state)) {
      if (Date.now() > end) {
        throw new Error(`not so after ${timeout} ms: ${isSo}, but ${JSON.stringify(this.state)}`);
      }
      await new Promise((done) => setTimeout(done, 50));
    }
    return this.state;
  }
}

async function startMockStudy() {
  const options = ["--port", "0", "--hvas", kProgram, "--dist", kPage, "--file", "../products/bushing.step", "--study"];
  const child = spawn("node", ["mock/server.mjs", ...options], { stdio: ["ignore", "pipe", "inherit"] });
  const ended = once(child, "exit");
  let said = "";
  const links = await new Promise((resolve, reject) => {
    child.stdout.on("data", (bytes) => {
      said += bytes;
      const found = said.match(/http:\S+/g) ?? [];
      if (found.length === 3) {
        resolve(found);
      }
    });
    child.on("exit", (code) => reject(new Error(`the mock ended with ${code}: ${said}`)));
  });
  const [operator, viewer, participant] = links;
  const others = [];
  return {
    operator,
    viewer,
    participant,
    join(link) {
      others.push(new Other(link));
      return others.at(-1);
    },
    /** Somebody does the trial that runs, by hand. */
    work: () => child.kill("SIGUSR1"),
    /** All connections are lost, for some seconds. */
    cut: () => child.kill("SIGUSR2"),
    stop: async () => {
      others.forEach(({ socket }) => socket.terminate());
      child.kill("SIGTERM");
      await ended;
    },
  };
}

/** Runs a test with a study, which ends with it. */
export function withMockStudy(run) {
  return async () => {
    const study = await startMockStudy();
    try {
      await run(study);
    } finally {
      await study.stop();
    }
  };
}
