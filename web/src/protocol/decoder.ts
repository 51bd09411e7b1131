/** Takes a binary message apart into its frames, and makes those of the client. */

import {
  FrameKind,
  HandInputSize,
  HeaderSize,
  AcknowledgementSize,
  kMagic,
  kVersion,
  readHeader,
  writeAcknowledgement,
  writeHandInput,
  writeHeader,
  type HandInput,
  type Header,
} from "./frames";

export interface FrameView {
  readonly header: Header;
  /** Of the first item. */
  readonly at: number;
}

/** Every whole frame from `at` on, of known kind or not. What is damaged ends the walk. */
export function* walkFrames(view: DataView, from = 0): Generator<FrameView, void> {
  let at = from;
  while (at + HeaderSize <= view.byteLength) {
    const header = readHeader(view, at);
    const isSound =
      header.magic === kMagic &&
      header.version === kVersion &&
      header.size >= HeaderSize &&
      at + header.size <= view.byteLength;
    if (!isSound) {
      break;
    }
    yield { header, at: at + HeaderSize };
    at += header.size;
  }
}

export function splitFrames(view: DataView): FrameView[] {
  return [...walkFrames(view)];
}

/** Items that fit into the frame, whatever its count says. */
export function itemCount(header: Header, itemSize: number): number {
  return Math.min(header.count, Math.floor((header.size - HeaderSize) / itemSize));
}

/** A frame with its header and room for its items. */
export function makeFrame(kind: number, epoch: number, count: number, itemSize: number, t_ns = 0n): DataView {
  const size = HeaderSize + count * itemSize;
  const view = new DataView(new ArrayBuffer(size));
  writeHeader(view, 0, { magic: kMagic, version: kVersion, kind, size, seq: 0, epoch, count, t_ns });
  return view;
}

export function makeInputFrame(epoch: number, inputs: readonly HandInput[]): ArrayBuffer {
  const view = makeFrame(FrameKind.Input, epoch, inputs.length, HandInputSize);
  inputs.forEach((input, k) => writeHandInput(view, HeaderSize + k * HandInputSize, input));
  return view.buffer as ArrayBuffer;
}

export function makeCreditFrame(epoch: number, seq: number): ArrayBuffer {
  const view = makeFrame(FrameKind.Credit, epoch, 1, AcknowledgementSize);
  writeAcknowledgement(view, HeaderSize, { seq });
  return view.buffer as ArrayBuffer;
}

/** Pieces of a message, one after the other. */
export function joinBytes(pieces: readonly Uint8Array[]): ArrayBuffer {
  const all = new Uint8Array(pieces.reduce((size, piece) => size + piece.byteLength, 0));
  let at = 0;
  for (const piece of pieces) {
    all.set(piece, at);
    at += piece.byteLength;
  }
  return all.buffer;
}
