// SIGTERM ends the studio, whatever it is doing. What would take longer than five seconds is cut off, with status 1.
import assert from "node:assert/strict";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { request } from "node:http";
import { connect as connectTcp } from "node:net";
import { describe, it } from "node:test";
import { join } from "node:path";
import { connect, makeFolder, runProgram, signIn, startStudio } from "./harness.mjs";

const kBushing = "../products/bushing.step";

/** Ends it while something is under way, and says with which status. */
async function endWhile(args, begin) {
  const studio = await startStudio(args);
  try {
    const leave = await begin(studio, await signIn(studio.operator));
    const status = await studio.stop();
    leave?.();
    assert.ok(status === 0 || status === 1, `it ends by itself, and not by signal: ${status}`);
    return status;
  } finally {
    await studio.kill();
  }
}

describe("SIGTERM", () => {
  it("ends it with nothing open", async () => {
    assert.equal(await endWhile([], () => {}), 0);
  });

  it("ends it while clients read nothing", async () => {
    const status = await endWhile([kBushing], async (studio, session) => {
      const client = await connect(session);
      await client.hasOpened();
      await client.send({ command: "next" });
      const { port } = new URL(session.origin);
      const deaf = await Promise.all(
        [0, 1, 2].map(async () => {
          const socket = connectTcp(Number(port), "127.0.0.1");
          await once(socket, "connect");
          socket.pause();
          socket.write(
            `GET /ws HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\nOrigin: ${session.origin}\r\nCookie: ${session.cookie}\r\n` +
              "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
          );
          return socket;
        }),
      );
      await client.find((each) => each.event === "roles" && each.clients.length === 4);
      return () => deaf.forEach((each) => each.destroy());
    });
    assert.equal(status, 0);
  });

  it("ends it while a file is being read", async () => {
    await endWhile(["../products/frame_500.step", "--no-cache"], async (studio, session) => {
      const client = await connect(session);
      await client.find((each) => each.event === "progress");
    });
  });

  it("ends it while a recording is being written, which is whole", async () => {
    const folder = makeFolder();
    let id = "";
    const status = await endWhile([kBushing, "--recordings", folder], async (studio, session) => {
      const client = await connect(session);
      await client.find((each) => each.event === "step" && each.index > 0);
      await client.send({ command: "record", on: true });
      ({ id } = await client.find((each) => each.event === "recording" && each.on));
      await client.send({ command: "next" });
      await client.find((each) => each.event === "taken");
    });
    assert.equal(status, 0);
    assert.match(runProgram(["replay", "--verify", join(folder, `${id}.hvasrec`)]), /./);
  });

  it("ends it while a request goes on for ever", async () => {
    const status = await endWhile([kBushing], async (studio, session) => {
      const { hostname, port } = new URL(session.origin);
      const upload = request({
        hostname,
        port,
        method: "POST",
        path: "/api/upload?name=a.step",
        headers: { Origin: session.origin, Cookie: session.cookie, "Content-Length": 1_000_000 },
      });
      upload.on("error", () => {});
      upload.write(readFileSync(kBushing).subarray(0, 1000));
      await once(upload, "socket");
      return () => upload.destroy();
    });
    assert.equal(status, 0);
  });

  it("ends it while it makes the model of a large product", async () => {
    await endWhile(["../products/frame_500.step"], async (studio, session) => {
      const client = await connect(session);
      await client.find((each) => each.event === "progress" && /shape|order/.test(each.stage));
    });
  });
});
