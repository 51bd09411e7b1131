/** Holds the WebSocket away from the page's main thread, which may be busy drawing. */

import { makeCreditFrame } from "./decoder";
import { FrameStore, nowMs } from "./frame_store";
import { SilenceWatch } from "./silence";
import type { FromWorker, ToWorker } from "./worker_messages";

declare const self: DedicatedWorkerGlobalScope;

/** A page that draws slowly still holds the part: its last input is repeated for it, but not for long. */
const kRepeatMs = 16;
const kRepeatForMs = 700;
const kRetryMs = [250, 500, 1000, 2000, 4000];
const kLookMs = 50;
/** The least that the server answers; nobody waits for the answer. */
const kQuestion = JSON.stringify({ id: 0, command: "status" });

let socket: WebSocket | null = null;
let store: FrameStore | null = null;
let isShared = false;
let url = "";
let failures = 0;
let input: ArrayBuffer | null = null;
let inputAt = 0;
let sentAt = 0;
const silence = new SilenceWatch();

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, transfer);
}

function tellOfSilenceOver(isOver: boolean): void {
  if (isOver) {
    tell({ type: "silence", isSilent: false });
  }
}

function connect(): void {
  socket = new WebSocket(url);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    failures = 0;
    tell({ type: "open" });
  };
  socket.onclose = () => {
    input = null;
    tellOfSilenceOver(silence.stop());
    tell({ type: "closed" });
    setTimeout(connect, kRetryMs[Math.min(failures++, kRetryMs.length - 1)]);
  };
  socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
    tellOfSilenceOver(silence.hear(nowMs()));
    if (typeof event.data === "string") {
      tell({ type: "text", text: event.data });
    } else {
      receive(event.data);
    }
  };
}

function receive(data: ArrayBuffer): void {
  if (!isShared || store === null) {
    tell({ type: "frames", data, receivedMs: nowMs() }, [data]);
    return;
  }
  const last = store.ingest(data, nowMs());
  if (last !== null) {
    send(makeCreditFrame(last.epoch, last.seq));
  }
}

function send(data: string | ArrayBuffer): void {
  if (socket?.readyState === WebSocket.OPEN) {
    socket.send(data);
  }
}

function repeatInput(): void {
  const now = nowMs();
  if (input !== null && now - sentAt >= kRepeatMs - 2) {
    if (now - inputAt > kRepeatForMs) {
      input = null;
      return;
    }
    sentAt = now;
    send(input);
  }
}

function lookForSilence(): void {
  switch (silence.look(nowMs())) {
    case "ask":
      send(kQuestion);
      break;
    case "tell":
      tell({ type: "silence", isSilent: true });
      break;
    default:
  }
}

self.onmessage = (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  switch (message.type) {
    case "connect":
      url = message.url;
      isShared = message.store !== null;
      store = message.store === null ? null : new FrameStore(message.store);
      connect();
      setInterval(repeatInput, kRepeatMs);
      setInterval(lookForSilence, kLookMs);
      break;
    case "text":
      send(message.text);
      break;
    case "credit":
      send(makeCreditFrame(message.epoch, message.seq));
      break;
    case "input":
      input = message.data;
      inputAt = sentAt = nowMs();
      send(message.data);
      break;
    case "rest":
      input = null;
      break;
  }
};
