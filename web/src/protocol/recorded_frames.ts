/**
 * The frames of a recording, and the way to any moment of it.
 *
 * A pose is in the file only when it changed, so the state at a moment follows from all that came before.
 * Every so many moments a key is kept: a message with all that is known by then. Going to a moment is the
 * key before it and the few messages from there, through the same store as what comes from the server.
 */

import { itemCount, joinBytes, makeFrame, walkFrames } from "./decoder";
import { FrameStore, nowMs } from "./frame_store";
import { BodyPoseSize, DeformationSize, FrameKind, HandStateSize, HeaderSize, readHandState, type HandState } from "./frames";

const kMomentsPerKey = 128;
const kSeqAt = 12;
const kEpochAt = 16;

/** What is known before a moment: a pose for each part, how far what gives is deformed, and the hands and contacts that
 were told last. */
class Known {
  private readonly poses = new Map<number, Uint8Array>();
  private readonly deformations = new Map<number, Uint8Array>();
  private hands: Uint8Array | null = null;
  private contacts: Uint8Array | null = null;

  takePoses(source: DataView, at: number, count: number): void {
    takeItems(source, at, count, BodyPoseSize, this.poses);
  }

  takeDeformations(source: DataView, at: number, count: number): void {
    takeItems(source, at, count, DeformationSize, this.deformations);
  }

  takeHands(frame: Uint8Array): void {
    this.hands = frame;
    this.contacts = null;
  }

  takeContacts(frame: Uint8Array): void {
    this.contacts = frame;
  }

  /** All of it as one message. */
  makeKey(epoch: number, t_ns: bigint): ArrayBuffer {
    const join = (kind: number, size: number, items: ReadonlyMap<number, Uint8Array>): Uint8Array => {
      const frame = new Uint8Array(makeFrame(kind, epoch, items.size, size, t_ns).buffer);
      [...items.values()].forEach((item, k) => frame.set(item, HeaderSize + k * size));
      return frame;
    };
    const poses = join(FrameKind.Poses, BodyPoseSize, this.poses);
    const deformations = join(FrameKind.Deformations, DeformationSize, this.deformations);
    return joinBytes([poses, deformations, this.hands, this.contacts].filter((piece) => piece !== null));
  }
}

/** Keeps the newest item of each index, which is the first field of an item. */
function takeItems(source: DataView, at: number, count: number, size: number, to: Map<number, Uint8Array>): void {
  for (let k = 0; k < count; k++) {
    const from = at + k * size;
    to.set(source.getUint32(from, true), bytesOf(source, from, size));
  }
}

function bytesOf(view: DataView, at: number, size: number): Uint8Array {
  return new Uint8Array(view.buffer, view.byteOffset + at, size);
}

export class RecordedFrames {
  /** Of each moment, from the beginning of the recording [s]. */
  readonly timesS: number[] = [];
  /** Whether every byte was a frame; else the rest is left out. */
  readonly isWhole: boolean;
  private readonly starts: number[] = [];
  private readonly keys: ArrayBuffer[] = [];

  /** @param bytes  The frames, one after the other; their headers are changed in place.
   @param epoch  What the frames shall say that they belong to: no live scene has it.
   @param onHand  Called for each hand of each moment, in order. */
  constructor(
    private readonly bytes: ArrayBuffer,
    readonly epoch: number,
    onHand: (timeS: number, hand: HandState) => void = () => {},
  ) {
    const view = new DataView(bytes);
    const known = new Known();
    let last: bigint | null = null;
    let end = 0;
    for (const { header, at } of walkFrames(view)) {
      const start = at - HeaderSize;
      if (header.t_ns !== last) {
        if (this.starts.length % kMomentsPerKey === 0) {
          this.keys.push(known.makeKey(epoch, last ?? header.t_ns));
        }
        this.starts.push(start);
        this.timesS.push(Number(header.t_ns) / 1e9);
        last = header.t_ns;
      }
      view.setUint32(start + kSeqAt, this.starts.length, true);
      view.setUint32(start + kEpochAt, epoch, true);
      const timeS = Number(header.t_ns) / 1e9;
      if (header.kind === FrameKind.Poses) {
        known.takePoses(view, at, itemCount(header, BodyPoseSize));
      } else if (header.kind === FrameKind.Deformations) {
        known.takeDeformations(view, at, itemCount(header, DeformationSize));
      } else if (header.kind === FrameKind.Hands) {
        known.takeHands(bytesOf(view, start, header.size));
        for (let k = 0; k < itemCount(header, HandStateSize); k++) {
          onHand(timeS, readHandState(view, at + k * HandStateSize));
        }
      } else if (header.kind === FrameKind.Contacts) {
        known.takeContacts(bytesOf(view, start, header.size));
      }
      end = start + header.size;
    }
    this.starts.push(end);
    this.isWhole = end === bytes.byteLength;
  }

  get count(): number {
    return this.timesS.length;
  }

  /** The last moment not after `timeS`, and the first one before all of them. */
  momentAt(timeS: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.timesS[middle] ?? 0) <= timeS) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return Math.max(0, low - 1);
  }

  /** What to feed to a store that shows one moment (-1: none) to make it show another one. */
  *messagesBetween(shown: number, wanted: number): Generator<ArrayBuffer, void> {
    const key = Math.floor(wanted / kMomentsPerKey);
    let next = shown + 1;
    if (wanted < shown || next < key * kMomentsPerKey) {
      yield this.keys[key]!;
      next = key * kMomentsPerKey;
    }
    for (; next <= wanted; next++) {
      yield this.bytes.slice(this.starts[next], this.starts[next + 1]);
    }
  }
}

/** A store that goes through a recording. */
export class FrameCursor {
  readonly store = new FrameStore();
  private shown = -1;

  constructor(private readonly frames: RecordedFrames) {}

  get moment(): number {
    return this.shown;
  }

  /** @return Whether it is another moment than before. */
  goTo(moment: number): boolean {
    const wanted = Math.min(Math.max(0, moment), this.frames.count - 1);
    if (wanted === this.shown || this.frames.count === 0) {
      return false;
    }
    for (const message of this.frames.messagesBetween(this.shown, wanted)) {
      this.store.ingest(message, nowMs());
    }
    this.shown = wanted;
    return true;
  }
}
