/** The session with the server: token, connection, commands out, events into the store. */

import { batch } from "@preact/signals";
import { CommandError, Connection } from "../protocol/connection";
import type { LiveState } from "../protocol/frame_store";
import { kNone, type HandInput } from "../protocol/frames";
import type { Command, CommandResults, Scene, ServerError, ServerEvent } from "../protocol/messages";
import { holdStateOf } from "./hints";
import { uploadFile } from "./upload";
import { makeStore, type HeldSummary, type LogKind } from "./store";

/** Bits of haptics::GateAction that a user has to know of: not finite, model late, client silent, device
 lost, buzz, kick. The others limit the force in the course of the work. */
const kAlarms = 0b1_1001_1100_0001;
/** An alarm is shown this long at least, and as long as its cause lasts. */
const kAlarmShownMs = 5000;
const kLogLength = 200;
const kRunsLength = 50;

export class Studio {
  readonly store = makeStore();
  private connection: Connection | null = null;
  private noticeId = 0;
  private alarmedAt = 0;
  private uploading: AbortController | null = null;

  /** Exchanges the token, where there is one, and connects. */
  async start(token: string | null): Promise<void> {
    if (token !== null) {
      const answer = await fetch("/api/session", {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify({ token }),
      }).catch(() => null);
      if (answer !== null && !answer.ok) {
        this.store.link.value = "denied";
        return;
      }
    }
    const url = new URL("/ws", location.href);
    url.protocol = url.protocol.replace("http", "ws");
    this.connection = new Connection(url.href, {
      onOpen: () => (this.store.link.value = "open"),
      onClosed: () => this.onClosed(),
      onEvent: (event) => this.onEvent(event),
    });
  }

  get frames() {
    return this.connection?.store ?? null;
  }

  /** Sends a command; a refusal is shown to the user and makes the promise null. */
  async command<K extends Command["command"]>(
    command: Extract<Command, { command: K }>,
  ): Promise<CommandResults[K] | null> {
    try {
      return (await this.connection?.send(command)) ?? null;
    } catch (error) {
      if (error instanceof CommandError) {
        this.notify([error.detail.message, error.detail.remedy].filter(Boolean).join(" "), true);
        return null;
      }
      throw error;
    }
  }

  sendInput(inputs: readonly HandInput[]): void {
    this.connection?.sendInput(inputs);
  }

  rest(): void {
    this.connection?.rest();
  }

  notify(text: string, isError = false): void {
    this.store.notice.value = { text, isError, id: ++this.noticeId };
  }

  async openUpload(file: File): Promise<void> {
    this.uploading = new AbortController();
    this.store.failure.value = null;
    try {
      const upload = await uploadFile(file, this.uploading.signal, (fraction) => {
        this.store.upload.value = { file: file.name, fraction };
      });
      await this.command({ command: "open", upload });
    } catch (error) {
      if (!this.uploading.signal.aborted) {
        this.store.failure.value = asServerError(error, file.name);
      }
    } finally {
      this.store.upload.value = null;
      this.uploading = null;
    }
  }

  cancelOpening(): void {
    this.uploading?.abort();
    if (this.store.loading.value !== null) {
      void this.command({ command: "cancel" });
      this.store.loading.value = null;
    }
  }

  /** What the frames say of the hands, told to the store when it differs from what is known. */
  noteHands(live: LiveState): void {
    const isAlarmed = live.hands.some((h) => (h.gate_actions & kAlarms) !== 0);
    if (this.store.safety.value !== null && !isAlarmed && performance.now() - this.alarmedAt > kAlarmShownMs) {
      this.store.safety.value = null;
    }
    const next: HeldSummary[] = live.hands
      .filter((h) => h.occurrence !== kNone && h.state !== 0)
      .map((h) => ({
        hand: h.hand,
        occurrence: h.occurrence,
        state: holdStateOf(h.state),
        mate: h.mate === kNone ? null : h.mate,
      }));
    const before = this.store.held.value;
    const isSame =
      next.length === before.length &&
      next.every((h, k) => {
        const b = before[k];
        return b?.hand === h.hand && b.occurrence === h.occurrence && b.state === h.state && b.mate === h.mate;
      });
    if (!isSame) {
      this.store.held.value = next;
    }
  }

  /** A socket that never opened may have been refused: only a plain request tells why. */
  private async noteRefusal(): Promise<void> {
    const answer = await fetch("/api/scene").catch(() => null);
    if (answer?.status === 401 || answer?.status === 403) {
      this.store.link.value = "denied";
    }
  }

  private onClosed(): void {
    if (this.store.link.value === "starting") {
      void this.noteRefusal();
    }
    batch(() => {
      if (this.store.link.value === "open") {
        this.store.link.value = "lost";
      }
      this.store.held.value = [];
      this.store.loading.value = null;
    });
  }

  private async fetchScene(): Promise<void> {
    const answer = await fetch("/api/scene");
    if (answer.status === 404) {
      this.store.scene.value = null;
      return;
    }
    if (!answer.ok) {
      this.notify(`${answer.status} ${answer.statusText}`, true);
      return;
    }
    const scene = (await answer.json()) as Scene;
    batch(() => {
      this.store.placements.value = new Map(scene.occurrences.map((o) => [o.id, o.placement]));
      this.store.step.value = { index: scene.next_step, total: scene.steps.length };
      this.store.scene.value = scene;
      this.store.loading.value = null;
      this.store.failure.value = null;
    });
  }

  private log(kind: LogKind, params: Record<string, string | number> = {}): void {
    this.store.log.value = [{ at: new Date(), kind, params }, ...this.store.log.value].slice(0, kLogLength);
  }

  private nameOf(occurrence: number): string {
    return this.store.occurrences.value.get(occurrence)?.name ?? `${occurrence}`;
  }

  private onEvent(event: ServerEvent): void {
    batch(() => this.apply(event));
  }

  private apply(event: ServerEvent): void {
    const store = this.store;
    switch (event.event) {
      case "hello":
        store.role.value = event.role;
        store.client.value = event.client;
        store.hasLease.value = event.has_lease;
        store.examples.value = event.examples;
        store.forcesOff.value = event.forces_off;
        if (event.has_scene) {
          void this.fetchScene();
        } else {
          store.scene.value = null;
        }
        break;
      case "progress":
        store.failure.value = null;
        store.loading.value = event;
        break;
      case "failed":
        store.loading.value = null;
        store.failure.value = event.error;
        this.log("failed", { text: event.error.message });
        break;
      case "scene":
        this.log("opened");
        void this.fetchScene();
        break;
      case "forces":
        store.forcesOff.value = event.off;
        if (!event.off) {
          store.safety.value = null;
        }
        this.log("forces", { off: event.off ? 1 : 0 });
        break;
      case "safety":
        this.noteSafety(event.reasons, event.gate_actions);
        break;
      case "roles":
        store.clients.value = event.clients;
        this.noteOwnRole(event.clients);
        break;
      case "history":
        store.history.value = { undo: event.undo, redo: event.redo };
        break;
      case "demo":
        store.demo.value = event.on;
        this.log("demo", { on: event.on ? 1 : 0 });
        break;
      case "status":
        store.status.value = event;
        break;
      default:
        this.applyAssembly(event);
    }
  }

  private noteSafety(reasons: string[], gateActions: number): void {
    const isAlarm = (gateActions & kAlarms) !== 0;
    if (isAlarm) {
      this.store.safety.value = { reasons };
      this.alarmedAt = performance.now();
    }
    if (reasons.length > 0) {
      this.log(isAlarm ? "safety" : "limit", { text: reasons.join(", ") });
    }
  }

  private noteOwnRole(clients: readonly { id: number; role: "operator" | "viewer"; has_lease: boolean }[]): void {
    const own = clients.find((c) => c.id === this.store.client.value);
    if (own !== undefined) {
      this.store.role.value = own.role;
      this.store.hasLease.value = own.has_lease;
    }
  }

  private applyAssembly(event: ServerEvent): void {
    const store = this.store;
    switch (event.event) {
      case "placement":
        store.placements.value = new Map(store.placements.value).set(event.occurrence, event.placement);
        break;
      case "taken":
        // What was cut stays so until the hand takes anew.
        store.safety.value = null;
        this.log("taken", { part: this.nameOf(event.occurrence) });
        break;
      case "state":
        if (event.occurrence !== undefined) {
          this.log("state", { part: this.nameOf(event.occurrence), state: holdStateOf(event.state) });
        }
        break;
      case "dropped": {
        const name = this.nameOf(event.occurrence);
        this.log("dropped", { part: name, seated: event.was_seated ? 1 : 0 });
        const run = { occurrence: event.occurrence, name, wasSeated: event.was_seated, metrics: event.metrics };
        store.runs.value = [run, ...store.runs.value].slice(0, kRunsLength);
        break;
      }
      case "step":
        store.step.value = { index: event.index, total: event.total };
        break;
      default:
        // An event of a newer server.
        break;
    }
  }
}

function asServerError(error: unknown, where: string): ServerError {
  if (error instanceof CommandError) {
    return error.detail;
  }
  return { code: "upload", message: error instanceof Error ? error.message : String(error), where, remedy: "" };
}
