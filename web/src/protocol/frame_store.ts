/**
 * The newest state of the scene, in one block of memory that a worker writes and the page reads.
 *
 * Newest wins: frames are merged as they come, so a page that is busy drawing finds the present when it
 * looks, never a queue. Where memory may not be shared, both sides use the same class over a block of
 * their own.
 */

import { itemCount, splitFrames } from "./decoder";
import {
  BodyPoseSize,
  ContactPointSize,
  DeformationSize,
  FrameKind,
  HandStateSize,
  kMaxHands,
  readContactPoint,
  readHandState,
  type ContactPoint,
  type HandState,
} from "./frames";

export const kMaxOccurrences = 16384;
export const kMaxContacts = 128;
export const kMaxDeformations = 4096;
export const kSampleSlots = 2048;
/** Of a sample: hand, time [s], then what `sampleOf` says. */
export const kSampleFloats = 16;

/** How long what is known of the server's clock counts without a frame [ms]. */
const kSilenceMs = 1000;
/** Between the speeds of two clocks, at most. */
const kDrift = 1e-4;
const kPoseFloats = 7;
const Control = {
  lock: 0,
  epoch: 1,
  seq: 2,
  bytes: 3,
  messages: 4,
  hands: 5,
  contacts: 6,
  samples: 7,
  generation: 8,
  deformations: 9,
  count: 16,
} as const;
const Clock = { server: 0, received: 1, offset: 2, count: 4 } as const;

const kClockAt = Control.count * 4;
const kHandsAt = kClockAt + Clock.count * 8;
const kContactsAt = kHandsAt + kMaxHands * HandStateSize;
const kSamplesAt = (kContactsAt + kMaxContacts * ContactPointSize + 7) & ~7;
const kPosesAt = kSamplesAt + kSampleSlots * kSampleFloats * 4;
const kVersionsAt = kPosesAt + kMaxOccurrences * kPoseFloats * 4;
const kAmountsAt = kVersionsAt + kMaxOccurrences * 4;
const kTotal = kAmountsAt + kMaxDeformations * 4;

/** Milliseconds of a clock that page and worker share. */
export function nowMs(): number {
  return performance.timeOrigin + performance.now();
}

/** What the plots know of a hand. */
export function sampleOf(hand: HandState): number[] {
  return [
    ...hand.f_felt_W_n,
    ...hand.t_felt_W_nm,
    hand.depth_m,
    hand.tilt_rad,
    hand.axial_true_n,
    hand.axial_felt_n,
    hand.peak_felt_n,
    hand.state,
    Math.hypot(...hand.f_true_W_n),
    hand.contact_count,
  ];
}

export interface LiveState {
  epoch: number;
  seq: number;
  /** Of the newest frame, on the clock of nowMs(), and how old it is. */
  sentMs: number;
  ageMs: number;
  hands: HandState[];
  contacts: ContactPoint[];
}

export type StoreBuffer = SharedArrayBuffer | ArrayBuffer;

export class FrameStore {
  readonly buffer: StoreBuffer;
  private readonly control: Int32Array;
  private readonly clock: Float64Array;
  private readonly bytes: Uint8Array;
  private readonly view: DataView;
  private readonly samples: Float32Array;
  private readonly poses: Float32Array;
  private readonly versions: Int32Array;
  private readonly amounts: Float32Array;

  constructor(buffer?: StoreBuffer) {
    this.buffer = buffer ?? new ArrayBuffer(kTotal);
    this.control = new Int32Array(this.buffer, 0, Control.count);
    this.clock = new Float64Array(this.buffer, kClockAt, Clock.count);
    this.bytes = new Uint8Array(this.buffer);
    this.view = new DataView(this.buffer);
    this.samples = new Float32Array(this.buffer, kSamplesAt, kSampleSlots * kSampleFloats);
    this.poses = new Float32Array(this.buffer, kPosesAt, kMaxOccurrences * kPoseFloats);
    this.versions = new Int32Array(this.buffer, kVersionsAt, kMaxOccurrences);
    this.amounts = new Float32Array(this.buffer, kAmountsAt, kMaxDeformations);
  }

  static makeShared(): FrameStore {
    return new FrameStore(new SharedArrayBuffer(kTotal));
  }

  get epoch(): number {
    return this.at(Control.epoch);
  }

  get bytesReceived(): number {
    return this.at(Control.bytes) >>> 0;
  }

  get messagesReceived(): number {
    return this.at(Control.messages);
  }

  /** Grows whenever a pose has changed. */
  get generation(): number {
    return this.at(Control.generation);
  }

  /** Grows whenever a part has been deformed by another amount. */
  get deformationGeneration(): number {
    return this.at(Control.deformations);
  }

  /** By how much one of the scene's deformables is deformed [m]. */
  readDeformation(index: number): number {
    return this.amounts[index] ?? 0;
  }

  /** Samples written so far; the last kSampleSlots of them can be read. */
  get sampleCount(): number {
    return this.at(Control.samples);
  }

  /** Merges one message; returns the sequence number to acknowledge, or null when it had no frames. */
  ingest(message: ArrayBuffer, receivedMs: number): { seq: number; epoch: number } | null {
    const source = new DataView(message);
    const frames = splitFrames(source);
    Atomics.add(this.control, Control.bytes, message.byteLength);
    Atomics.add(this.control, Control.messages, 1);
    const last = frames[frames.length - 1];
    if (last === undefined) {
      return null;
    }
    Atomics.add(this.control, Control.lock, 1);
    this.enterEpoch(last.header.epoch);
    this.tellTime(Number(last.header.t_ns) / 1e6, receivedMs);
    let hasHands = false;
    let hasContacts = false;
    for (const { header, at } of frames) {
      if (header.kind === FrameKind.Poses) {
        this.takePoses(source, at, itemCount(header, BodyPoseSize));
      } else if (header.kind === FrameKind.Hands) {
        hasHands = true;
        this.takeHands(source, at, itemCount(header, HandStateSize));
      } else if (header.kind === FrameKind.Contacts) {
        hasContacts = true;
        this.takeContacts(source, at, itemCount(header, ContactPointSize));
      } else if (header.kind === FrameKind.Deformations) {
        this.takeDeformations(source, at, itemCount(header, DeformationSize));
      }
    }
    if (hasHands && !hasContacts) {
      this.control[Control.contacts] = 0;
    }
    this.control[Control.seq] = last.header.seq | 0;
    Atomics.add(this.control, Control.lock, 1);
    return { seq: last.header.seq, epoch: last.header.epoch };
  }

  /** The present, or null while it is being written for too long. */
  read(): LiveState | null {
    for (let attempt = 0; attempt < 8; attempt++) {
      const before = Atomics.load(this.control, Control.lock);
      if (before % 2 !== 0) {
        continue;
      }
      const state = this.copy();
      if (Atomics.load(this.control, Control.lock) === before) {
        return state;
      }
    }
    return null;
  }

  /** The version of an occurrence's pose: 0 before the first one of this epoch. */
  poseVersion(occurrence: number): number {
    return this.versions[occurrence] ?? 0;
  }

  /** Position, then quaternion w, x, y, z, into `out`. */
  readPose(occurrence: number, out: Float32Array | number[]): void {
    const from = occurrence * kPoseFloats;
    for (let k = 0; k < kPoseFloats; k++) {
      out[k] = this.poses[from + k] ?? 0;
    }
  }

  /** Sample number `index` since the start, into `out`. */
  readSample(index: number, out: Float32Array): void {
    const from = (index % kSampleSlots) * kSampleFloats;
    out.set(this.samples.subarray(from, from + kSampleFloats));
  }

  private at(field: number): number {
    return Atomics.load(this.control, field);
  }

  private copy(): LiveState {
    const hands: HandState[] = [];
    const contacts: ContactPoint[] = [];
    for (let k = 0; k < this.at(Control.hands); k++) {
      hands.push(readHandState(this.view, kHandsAt + k * HandStateSize));
    }
    for (let k = 0; k < this.at(Control.contacts); k++) {
      contacts.push(readContactPoint(this.view, kContactsAt + k * ContactPointSize));
    }
    const sentMs = (this.clock[Clock.server] ?? 0) + (this.clock[Clock.offset] ?? 0);
    const ageMs = sentMs === 0 ? 0 : Math.max(0, nowMs() - sentMs);
    return { epoch: this.epoch, seq: this.at(Control.seq) >>> 0, sentMs, ageMs, hands, contacts };
  }

  private enterEpoch(epoch: number): void {
    if (this.control[Control.epoch] === epoch) {
      return;
    }
    this.control[Control.epoch] = epoch;
    this.control[Control.hands] = 0;
    this.control[Control.contacts] = 0;
    this.versions.fill(0);
    this.amounts.fill(0);
    Atomics.add(this.control, Control.deformations, 1);
  }

  /** The least difference seen between the clocks is the one of a frame that did not wait. It may creep up slowly, for
   two clocks never run at quite the same speed; after a silence it is found anew, for one of them may have stood still. */
  private tellTime(serverMs: number, receivedMs: number): void {
    const offset = receivedMs - serverMs;
    const known = this.clock[Clock.offset] ?? 0;
    const elapsedMs = receivedMs - this.receivedMs;
    const serverBefore = this.clock[Clock.server] ?? 0;
    const isNew = serverBefore === 0 || serverMs < serverBefore || elapsedMs > kSilenceMs;
    this.clock[Clock.offset] = isNew ? offset : Math.min(offset, known + kDrift * elapsedMs);
    this.clock[Clock.server] = serverMs;
    this.clock[Clock.received] = receivedMs;
  }

  private get receivedMs(): number {
    return this.clock[Clock.received] ?? 0;
  }

  private takePoses(source: DataView, at: number, count: number): void {
    for (let k = 0; k < count; k++) {
      const from = at + k * BodyPoseSize;
      const occurrence = source.getUint32(from, true);
      if (occurrence >= kMaxOccurrences) {
        continue;
      }
      for (let i = 0; i < kPoseFloats; i++) {
        this.poses[occurrence * kPoseFloats + i] = source.getFloat32(from + 4 + 4 * i, true);
      }
      this.versions[occurrence] = (this.versions[occurrence] ?? 0) + 1;
    }
    if (count > 0) {
      Atomics.add(this.control, Control.generation, 1);
    }
  }

  private takeDeformations(source: DataView, at: number, count: number): void {
    for (let k = 0; k < count; k++) {
      const index = source.getUint32(at + k * DeformationSize, true);
      if (index < kMaxDeformations) {
        this.amounts[index] = source.getFloat32(at + k * DeformationSize + 4, true);
      }
    }
    Atomics.add(this.control, Control.deformations, 1);
  }

  private takeHands(source: DataView, at: number, count: number): void {
    const kept = Math.min(count, kMaxHands);
    this.bytes.set(new Uint8Array(source.buffer, source.byteOffset + at, kept * HandStateSize), kHandsAt);
    this.control[Control.hands] = kept;
    for (let k = 0; k < kept; k++) {
      this.addSample(readHandState(source, at + k * HandStateSize));
    }
  }

  private addSample(hand: HandState): void {
    const index = this.at(Control.samples);
    const to = (index % kSampleSlots) * kSampleFloats;
    // Of the day, so that a float holds it to a hundredth of a second and better.
    const sentMs = ((this.clock[Clock.server] ?? 0) + (this.clock[Clock.offset] ?? 0)) % 1e7;
    const values = [hand.hand, sentMs / 1e3, ...sampleOf(hand)];
    this.samples.set(values, to);
    Atomics.store(this.control, Control.samples, index + 1);
  }

  private takeContacts(source: DataView, at: number, count: number): void {
    const kept = Math.min(count, kMaxContacts);
    this.bytes.set(new Uint8Array(source.buffer, source.byteOffset + at, kept * ContactPointSize), kContactsAt);
    this.control[Control.contacts] = kept;
  }
}
