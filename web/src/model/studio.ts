/** The session with the server: token, connection, commands out, events into the store. */

import { batch } from "@preact/signals";
import { CommandError, Connection } from "../protocol/connection";
import type { LiveState } from "../protocol/frame_store";
import type { HandInput } from "../protocol/frames";
import type { Command, CommandResults, Role, Scene, ServerError, ServerEvent } from "../protocol/messages";
import { CollisionCounter } from "./collisions";
import { addToLog, countLimits, isAlarm, kAlarms, kRunsLength, runOf, tell, type Told } from "./event_log";
import { lastingTroubles, withTrouble } from "./hands";
import { isSameHeld, summarize } from "./held";
import { noteClients, noteOthers } from "./people";
import { ProductOpening } from "./product_opening";
import { Recordings } from "./recordings";
import { exchangeToken, readError } from "./session";
import { leadersOf, makeStore, withLeader } from "./store";
import { StudyModel } from "./study";

/** An alarm is shown this long at least, and as long as its cause lasts. */
const kAlarmShownMs = 5000;

export class Studio {
  readonly store = makeStore();
  readonly opening = new ProductOpening(this.store, this);
  readonly recordings = new Recordings(this.store, this);
  readonly study = new StudyModel(this.store, this, globalThis.navigator?.languages ?? []);
  private connection: Connection | null = null;
  private readonly collisions = new CollisionCounter();
  /** What was told of the assembly while its scene was on its way: the scene may be older than that. */
  private toldSince: ServerEvent[] = [];
  private scenesOnTheWay = 0;
  private noticeId = 0;
  private alarmedAt = 0;

  /** Exchanges the token, where there is one, and connects. */
  async start(token: string | null): Promise<void> {
    const admission = await exchangeToken(token);
    if (admission.isDenied) {
      return this.deny(admission.error);
    }
    if (admission.role !== null) {
      this.greet(admission.role);
    }
    const url = new URL("/ws", location.href);
    url.protocol = url.protocol.replace("http", "ws");
    this.connection = new Connection(url.href, {
      onOpen: () => (this.store.link.value = "open"),
      onClosed: () => this.onClosed(),
      onSilence: (isSilent) => (this.store.isSilent.value = isSilent),
      onEvent: (event) => this.onEvent(event),
    });
  }

  /** What is to be drawn: live, or of a recording. */
  get frames() {
    return this.recordings.playback.peek()?.store ?? this.liveFrames;
  }

  get liveFrames() {
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

  /** Sends a command whose refusal concerns nobody. */
  async tell(command: Command): Promise<void> {
    await this.connection?.send(command).catch(() => null);
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

  /** What the frames say of the hands, told to the store when it differs from what is known. */
  noteHands(live: LiveState): void {
    const playback = this.recordings.playback.peek();
    if (playback !== null) {
      playback.noteHands(live);
      return;
    }
    const isAlarmed = live.hands.some((h) => (h.gate_actions & kAlarms) !== 0);
    if (this.store.safety.value !== null && !isAlarmed && performance.now() - this.alarmedAt > kAlarmShownMs) {
      this.store.safety.value = null;
    }
    this.collisions.note(live.hands);
    const next = summarize(live.hands);
    if (!isSameHeld(next, this.store.live.held.value)) {
      this.store.live.held.value = next;
    }
  }

  /** A socket that never opened may have been refused: only a plain request tells why. */
  private async noteRefusal(): Promise<void> {
    const answer = await fetch("/api/scene").catch(() => null);
    if ((answer?.status === 401 || answer?.status === 403) && this.store.link.value !== "open") {
      this.deny(await readError(answer));
    }
  }

  private deny(error: ServerError | null): void {
    [this.store.denial.value, this.store.link.value] = [error, "denied"];
  }

  private onClosed(): void {
    if (this.store.link.value !== "open") {
      void this.noteRefusal();
    }
    batch(() => {
      if (this.store.link.value === "open") {
        this.store.link.value = "lost";
      }
      this.store.live.held.value = [];
      this.store.loading.value = null;
    });
  }

  private async fetchScene(): Promise<void> {
    this.scenesOnTheWay += 1;
    try {
      await this.readScene();
    } finally {
      this.scenesOnTheWay -= 1;
      this.toldSince = this.scenesOnTheWay > 0 ? this.toldSince : [];
    }
  }

  private async readScene(): Promise<void> {
    const answer = await fetch("/api/scene");
    if (answer.status === 404) {
      this.store.live.scene.value = null;
      return;
    }
    if (!answer.ok) {
      this.notify(`${answer.status} ${answer.statusText}`, true);
      return;
    }
    const scene = (await answer.json()) as Scene;
    batch(() => {
      const { live } = this.store;
      live.placements.value = new Map(scene.occurrences.map((o) => [o.id, o.placement]));
      live.leaders.value = leadersOf(scene);
      live.step.value = { index: scene.next_step, total: scene.steps.length + scene.pending };
      live.scene.value = scene;
      this.toldSince.filter(isOfPlaces).forEach((event) => this.applyAssembly(event));
      this.store.loading.value = scene.pending > 0 ? this.store.loading.value : null;
    });
  }

  private log(told: Told | null): void {
    const { log } = this.store.live;
    if (told !== null) {
      log.value = addToLog(log.value, { at: new Date(), ...told });
    }
  }

  private readonly nameOf = (occurrence: number): string =>
    this.store.live.scene.peek()?.occurrences.find((o) => o.id === occurrence)?.name ?? `${occurrence}`;

  private onEvent(event: ServerEvent): void {
    if (this.scenesOnTheWay > 0) {
      // Another product has other parts: what was told before concerns none of them.
      this.toldSince = event.event === "scene" ? [] : [...this.toldSince, event];
    }
    batch(() => this.apply(event));
  }

  private apply(event: ServerEvent): void {
    const store = this.store;
    this.log(tell(event, this.nameOf));
    switch (event.event) {
      case "hello":
        this.greet(event.role);
        store.client.value = event.client;
        store.hasLease.value = event.has_lease;
        store.isOwner.value = event.is_owner;
        store.examples.value = event.examples;
        store.forcesOff.value = event.forces_off;
        store.demo.value = event.demo;
        if (event.has_scene) {
          void this.fetchScene();
        } else {
          store.live.scene.value = null;
        }
        store.hands.value = event.hands ?? [];
        this.recordings.note(event.recording ?? null);
        if (event.role === "participant") {
          void this.study.refresh();
        }
        break;
      case "progress":
        store.failure.value = null;
        store.loading.value = event;
        break;
      case "failed":
        store.loading.value = null;
        if (event.error.code !== "cancelled") {
          store.failure.value = event.error;
        }
        break;
      case "scene":
        store.failure.value = null;
        void this.fetchScene();
        break;
      case "forces":
        store.forcesOff.value = event.off;
        if (!event.off) {
          store.safety.value = null;
        }
        break;
      case "safety":
        if (isAlarm(event)) {
          store.safety.value = { reasons: event.reasons };
          this.alarmedAt = performance.now();
        }
        store.live.limits.value = countLimits(store.live.limits.value, event);
        break;
      case "roles":
        noteClients(store, event.clients);
        break;
      case "lease_asked":
      case "part_asked":
      case "looking":
      case "notes":
        noteOthers(store, event);
        break;
      case "history":
        store.history.value = { undo: event.undo, redo: event.redo };
        break;
      case "order_progress":
        store.orderProgress.value = event;
        break;
      case "demo":
        store.demo.value = event.on;
        break;
      case "status":
        store.status.value = event;
        break;
      case "hands":
        store.hands.value = event.hands;
        store.deviceTroubles.value = lastingTroubles(store.deviceTroubles.value, event.hands);
        break;
      case "device":
        store.deviceTroubles.value = withTrouble(store.deviceTroubles.value, event);
        break;
      case "devices":
        store.devices.value = event;
        break;
      case "recording":
        this.log(this.recordings.note(event));
        break;
      case "study":
        this.study.take(event);
        break;
      case "recordings":
        void this.recordings.fetchList();
        break;
      default:
        this.applyAssembly(event);
    }
  }

  private greet(role: Role): void {
    this.store.role.value = role;
    this.store.isGreeted.value = true;
  }

  private applyAssembly(event: ServerEvent): void {
    const { live, safety } = this.store;
    switch (event.event) {
      case "placement":
        live.placements.value = new Map(live.placements.value).set(event.occurrence, event.placement);
        live.leaders.value = withLeader(live.leaders.value, event.occurrence, event.leader);
        break;
      case "taken":
        // What was cut stays so until the hand takes anew.
        safety.value = null;
        break;
      case "dropped": {
        const run = runOf(event, this.nameOf, this.collisions.take(event.hand));
        live.runs.value = run === null ? live.runs.value : [run, ...live.runs.value].slice(0, kRunsLength);
        break;
      }
      case "step":
        live.step.value = { index: event.index, total: event.total };
        break;
      default: // One that is only told, or an event of a newer server.
        break;
    }
  }
}

function isOfPlaces(event: ServerEvent): boolean {
  return event.event === "placement" || event.event === "step";
}
