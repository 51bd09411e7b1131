// A studio with a small study, for a test: its links, somebody at the other end, and a line that can be cut.
import { writeFileSync } from "node:fs";
import { createServer, connect } from "node:net";
import { once } from "node:events";
import { join } from "node:path";
import { makeFolder, startStudio } from "./harness.mjs";
import { StudyPeer } from "./study_peer.mjs";

/** A training, a trial by hand, two to identify, one by picking, and two questions. */
const kProtocol = `format: hvas-study-1
id: small
title: {en: Fits that are felt, de: "Passungen, die man fühlt"}
product: bushing
part: shaft
participants: 1
languages: [en, de]
consent:
  en: You will put a shaft into a bushing. You may stop at any time.
  de: Sie setzen eine Welle in eine Buchse. Sie können jederzeit aufhören.
defaults: {fit: H7/g6, time_limit_s: 300}
conditions:
  - {id: A1, name: {en: Constraints by mouse}, method: constraints_by_picking, instruction: {en: Pick the surfaces that belong together., de: "Wählen Sie die Flächen, die zusammengehören."}}
  - {id: B1, name: {en: Clearance}, method: hybrid, instruction: &hand {en: Put the shaft into the bushing., de: Setzen Sie die Welle in die Buchse.}}
  - {id: B2, name: {en: Interference}, method: hybrid, fit: H7/p6, instruction: *hand}
training: {minutes: 10, condition: B1}
blocks:
  - {id: timed, conditions: [B1], order: given}
  - {id: blind, conditions: [B1, B2], identification: true, question: {en: "Which fit was it?", de: "Welche Passung war es?"}}
  - {id: picked, conditions: [A1], order: given}
questions:
  - {id: steady, kind: scale, asked: at_end, text: {en: "How steady did the force feel?", de: "Wie stetig fühlte sich die Kraft an?"}, low: 1, high: 10}
  - {id: remarks, kind: text, asked: at_end, text: {en: "Is there anything else?", de: "Noch etwas?"}, longest: 200}
hidden: [condition]
`;

/** A line to a port of this machine, with a port of its own of as many digits: addresses that go over it are those of
 the other end. */
async function openLine(port) {
  const ends = new Set();
  const line = createServer((near) => {
    const far = connect(port, "127.0.0.1");
    const own = String(line.address().port);
    const rewrite = (bytes, from, to) => Buffer.from(bytes.toString("latin1").replaceAll(`127.0.0.1:${from}`, `127.0.0.1:${to}`), "latin1");
    near.on("data", (bytes) => far.write(rewrite(bytes, own, port)));
    far.on("data", (bytes) => near.write(bytes));
    for (const [end, other] of [[near, far], [far, near]]) {
      ends.add(end);
      end.on("error", () => {}).on("close", () => ends.delete(end) && other.destroy());
    }
  });
  const listen = async (at) => {
    line.listen(at, "127.0.0.1");
    await once(line, "listening");
  };
  await listen(0);
  const { port: own } = line.address();
  return {
    port: own,
    /** All connections are lost; and none come about until it is mended. */
    cut: async () => {
      line.close();
      ends.forEach((end) => end.destroy());
      await once(line, "close");
    },
    mend: () => listen(own),
    close: () => {
      line.close();
      ends.forEach((end) => end.destroy());
    },
  };
}

/** Runs a test with a study, which ends with it. */
export function withStudy(run) {
  return async () => {
    const folder = makeFolder();
    const protocol = join(folder, "small.yaml");
    writeFileSync(protocol, kProtocol);
    const studio = await startStudio(["--study", protocol, "--participant", "P01", "-o", join(folder, "results")]);
    const others = [];
    const lines = [];
    try {
      await run({
        ...studio,
        join(link) {
          others.push(new StudyPeer(link));
          return others.at(-1);
        },
        /** A link by a line that can be cut. */
        async overLine(link) {
          const line = await openLine(new URL(link).port);
          lines.push(line);
          const { hash } = new URL(link);
          return { ...line, link: `http://127.0.0.1:${line.port}/${hash}` };
        },
      });
    } finally {
      await Promise.allSettled(others.map((other) => other.leave()));  // Their sockets would keep this program from ending.
      lines.forEach((line) => line.close());
      await studio.kill();
    }
  };
}
