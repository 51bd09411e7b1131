/** The recordings that the server keeps: their list, and the one that is shown. */

import { batch, signal } from "@preact/signals";
import { CommandError } from "../protocol/connection";
import { sampleOf } from "../protocol/frame_store";
import { kMaxHands } from "../protocol/frames";
import type { RecordingDetail, RecordingEntry, RecordingNow, Scene, ServerError } from "../protocol/messages";
import { RecordedFrames } from "../protocol/recorded_frames";
import type { Announcer, Commander } from "./commander";
import type { Told } from "./event_log";
import { Playback, type RecordedRun } from "./playback";
import type { Store } from "./store";
import { Trace } from "./trace";

/** Above those of all scenes of a server. */
const kFirstEpoch = 0x40000000;
/** Recordings that stay in memory. */
const kKeptRuns = 6;

let epochs = 0;

/** Takes the frames of a recording into the page. */
export function makeRun(detail: RecordingDetail, bytes: ArrayBuffer): RecordedRun {
  const traces = Array.from({ length: kMaxHands }, () => new Trace());
  const frames = new RecordedFrames(bytes, kFirstEpoch + epochs++, (timeS, hand) => {
    traces[hand.hand]?.push(timeS, sampleOf(hand));
  });
  return { detail, frames, traces };
}

async function fetchOk(address: string): Promise<Response> {
  const answer = await fetch(address);
  if (!answer.ok) {
    const body = (await answer.json().catch(() => null)) as { error?: ServerError } | null;
    throw body?.error ? new CommandError(body.error) : new Error(`${address}: ${answer.status} ${answer.statusText}`);
  }
  return answer;
}

async function fetchJson<T>(address: string): Promise<T> {
  return (await (await fetchOk(address)).json()) as T;
}

export class Recordings {
  /** What is shown in place of the live work. */
  readonly playback = signal<Playback | null>(null);
  /** The name of the one that is being fetched. */
  readonly fetching = signal<string | null>(null);
  /** The one that has just been finished, until it is looked at. */
  readonly lastMade = signal<string | null>(null);
  private readonly runs = new Map<string, Promise<RecordedRun>>();
  private openCount = 0;

  constructor(
    private readonly store: Store,
    private readonly studio: Commander & Announcer,
  ) {}

  /** The server records, or does not any more. @return What there is to tell. */
  note(event: RecordingNow | null): Told | null {
    const { recording } = this.store;
    const before = recording.value;
    const isOn = event?.on === true;
    recording.value = isOn ? { id: event.id, name: event.name, sinceMs: performance.now() - 1e3 * event.t_s } : null;
    if (isOn === (before !== null)) {
      return null;
    }
    if (before !== null) {
      this.lastMade.value = before.id;
    }
    return { kind: "recording", params: { on: isOn ? 1 : 0, name: event?.name ?? before?.name ?? "" } };
  }

  async fetchList(): Promise<void> {
    const list = await this.attempt(fetchJson<{ recordings: RecordingEntry[] }>("/api/recordings"));
    if (list !== null) {
      this.store.recordings.value = [...list.recordings].sort((a, b) => b.started_unix_ms - a.started_unix_ms);
    }
  }

  /** Everything of a recording but its scene; what was fetched lately is there at once. */
  fetchRun(id: string): Promise<RecordedRun> {
    const known = this.runs.get(id);
    if (known !== undefined) {
      return known;
    }
    const fetched = fetchRun(id);
    this.runs.set(id, fetched);
    fetched.catch(() => this.runs.delete(id));
    if (this.runs.size > kKeptRuns) {
      this.runs.delete(this.runs.keys().next().value!);
    }
    return fetched;
  }

  /** Shows a recording from one of its moments on. @return Whether it is shown. */
  async open(id: string, timeS = 0): Promise<boolean> {
    const turn = ++this.openCount;
    const entry = this.store.recordings.peek()?.find((each) => each.id === id);
    this.fetching.value = entry?.name ?? id;
    const fetched = await this.attempt(
      Promise.all([this.fetchRun(id), fetchJson<Scene>(`/api/recording/${encodeURIComponent(id)}/scene`)]),
    );
    if (turn !== this.openCount) {
      return false;
    }
    this.fetching.value = null;
    if (fetched === null) {
      return false;
    }
    const [run, scene] = fetched;
    const playback = new Playback(run, scene, entry?.started_unix_ms ?? 0);
    playback.seek(timeS);
    batch(() => {
      this.lastMade.value = null;
      this.playback.value = playback;
      this.store.replay.value = playback;
    });
    return true;
  }

  /** Back to what is live. */
  close(): void {
    this.openCount += 1;
    batch(() => {
      this.fetching.value = null;
      this.playback.value = null;
      this.store.replay.value = null;
    });
  }

  /** @return Whether it has the name now. */
  async rename(id: string, name: string): Promise<boolean> {
    if ((await this.studio.command({ command: "rename_recording", recording: id, name })) === null) {
      return false;
    }
    const renamed = (entry: RecordingEntry) => (entry.id === id ? { ...entry, name } : entry);
    this.store.recordings.value = this.store.recordings.peek()?.map(renamed) ?? null;
    this.runs.delete(id);
    return true;
  }

  /** Shares a recording with all who have a link, or no more; the list follows by an event. */
  async share(id: string, shared: boolean): Promise<void> {
    await this.studio.command({ command: "share_recording", recording: id, shared });
  }

  async remove(id: string): Promise<void> {
    if ((await this.studio.command({ command: "delete_recording", recording: id })) === null) {
      return;
    }
    this.runs.delete(id);
    this.store.recordings.value = this.store.recordings.peek()?.filter((each) => each.id !== id) ?? null;
    if (this.lastMade.peek() === id) {
      this.lastMade.value = null;
    }
    if (this.playback.peek()?.run.detail.id === id) {
      this.close();
    }
  }

  /** A failure is told to the user and makes the promise null. */
  async attempt<T>(work: Promise<T>): Promise<T | null> {
    try {
      return await work;
    } catch (error) {
      const detail = error instanceof CommandError ? error.detail : { message: String(error), remedy: "" };
      this.studio.notify([detail.message, detail.remedy].filter(Boolean).join(" "), true);
      return null;
    }
  }
}

async function fetchRun(id: string): Promise<RecordedRun> {
  const detail = await fetchJson<RecordingDetail>(`/api/recording/${encodeURIComponent(id)}`);
  const frames = await fetchOk(detail.frames);
  return makeRun(detail, await frames.arrayBuffer());
}
