/** The page's end of the connection: commands out, events in, frames into a store. */

import { makeInputFrame } from "./decoder";
import type { HandInput } from "./frames";
import { FrameStore } from "./frame_store";
import type { Command, CommandResults, ServerError, ServerEvent } from "./messages";
import type { FromWorker, ToWorker } from "./worker_messages";

export interface ConnectionHandlers {
  onOpen(): void;
  onClosed(): void;
  /** The server says nothing any more, or speaks again. */
  onSilence(isSilent: boolean): void;
  onEvent(event: ServerEvent): void;
}

interface Waiting {
  resolve(result: unknown): void;
  reject(error: CommandError): void;
}

type Reply = { id: number; ok: true; result?: unknown } | { id: number; ok: false; error: ServerError };

export class CommandError extends Error {
  constructor(readonly detail: ServerError) {
    super(detail.message);
  }
}

export class Connection {
  readonly store: FrameStore;
  private readonly worker: Worker;
  private readonly waiting = new Map<number, Waiting>();
  private nextId = 1;

  constructor(
    url: string,
    private readonly handlers: ConnectionHandlers,
  ) {
    const canShare = typeof SharedArrayBuffer !== "undefined" && globalThis.crossOriginIsolated === true;
    this.store = canShare ? FrameStore.makeShared() : new FrameStore();
    this.worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => this.receive(event.data);
    this.post({ type: "connect", url, store: canShare ? this.store.buffer : null });
  }

  /** Sends a command; the promise is its answer. */
  send<K extends Command["command"]>(command: Extract<Command, { command: K; id?: never }>): Promise<CommandResults[K]> {
    const id = this.nextId++;
    this.post({ type: "text", text: JSON.stringify({ ...command, id }) });
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve: (result) => resolve(result as CommandResults[K]), reject });
    });
  }

  /** Where the hands should be; repeated by the worker until the next call or rest(). */
  sendInput(inputs: readonly HandInput[]): void {
    const data = makeInputFrame(this.store.epoch, inputs);
    this.post({ type: "input", data }, [data]);
  }

  rest(): void {
    this.post({ type: "rest" });
  }

  private post(message: ToWorker, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }

  private receive(message: FromWorker): void {
    switch (message.type) {
      case "open":
        this.handlers.onOpen();
        break;
      case "closed":
        this.failAll();
        this.handlers.onClosed();
        break;
      case "text":
        this.receiveText(message.text);
        break;
      case "silence":
        this.handlers.onSilence(message.isSilent);
        break;
      case "frames": {
        const last = this.store.ingest(message.data, message.receivedMs);
        if (last !== null) {
          this.post({ type: "credit", ...last });
        }
        break;
      }
    }
  }

  private receiveText(text: string): void {
    const message = JSON.parse(text) as ServerEvent | Reply;
    if ("event" in message) {
      this.handlers.onEvent(message);
      return;
    }
    const waiting = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.ok) {
      waiting?.resolve(message.result ?? {});
    } else {
      waiting?.reject(new CommandError(message.error));
    }
  }

  private failAll(): void {
    const error = { code: "disconnected", message: "The connection was lost.", where: "", remedy: "" };
    for (const waiting of this.waiting.values()) {
      waiting.reject(new CommandError(error));
    }
    this.waiting.clear();
  }
}
