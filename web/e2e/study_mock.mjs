// The mock server with a tiny study, for a test: its links, somebody at the other end, and how to end it.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { StudyPeer } from "./study_peer.mjs";

const kProgram = process.env["HVAS_BINARY"] ?? "../build/release/src/app/hvas";
const kPage = process.env["HVAS_PAGE"] ?? "../build/web/dist";

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
      others.push(new StudyPeer(link));
      return others.at(-1);
    },
    /** Somebody puts the part of the trial that runs half in, by hand; and when that has been seen, wholly. */
    work: () => child.kill("SIGUSR1"),
    /** All connections are lost; and none come about until they are mended. */
    cut: () => child.kill("SIGUSR2"),
    mend: () => child.kill("SIGUSR2"),
    stop: async () => {
      await Promise.all(others.map((other) => other.leave()));
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
