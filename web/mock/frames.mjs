// Packs and unpacks frames by the schema itself, so that the mock cannot lag behind it.

import { readFileSync } from "node:fs";

const schema = JSON.parse(readFileSync(new URL("../../src/studio/protocol.json", import.meta.url), "utf8"));
const SIZE = { u16: 2, u32: 4, i64: 8, f32: 4 };
const SUFFIX = { u16: "Uint16", u32: "Uint32", i64: "BigInt64", f32: "Float32" };
const HEADER = 32;

const sizeOf = (fields) => fields.reduce((n, [, kind, count]) => n + SIZE[kind] * count, 0);

function write(view, at, fields, item) {
  for (const [name, kind, count] of fields) {
    for (let k = 0; k < count; k++) {
      const value = count > 1 ? (item[name]?.[k] ?? 0) : (item[name] ?? 0);
      view[`set${SUFFIX[kind]}`](at, kind === "i64" ? BigInt(value) : value, true);
      at += SIZE[kind];
    }
  }
}

function read(view, at, fields) {
  const item = {};
  for (const [name, kind, count] of fields) {
    const values = Array.from({ length: count }, (_, k) => view[`get${SUFFIX[kind]}`](at + k * SIZE[kind], true));
    item[name] = count > 1 ? values : values[0];
    at += SIZE[kind] * count;
  }
  return item;
}

export const NONE = schema.constants.kNone;

export function packFrame(name, seq, epoch, t_ns, items) {
  const frame = schema.frames.find((f) => f.name === name);
  const fields = schema.items[frame.item];
  const size = HEADER + items.length * sizeOf(fields);
  const view = new DataView(new ArrayBuffer(size));
  const magic = new TextEncoder().encode(schema.magic).reduceRight((n, byte) => n * 256 + byte, 0);
  write(view, 0, schema.header, { magic, version: schema.version, kind: frame.kind, size, seq, epoch, count: items.length, t_ns });
  items.forEach((item, k) => write(view, HEADER + k * sizeOf(fields), fields, item));
  return Buffer.from(view.buffer);
}

export function unpackFrame(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const header = read(view, 0, schema.header);
  const frame = schema.frames.find((f) => f.kind === header.kind);
  const fields = schema.items[frame.item];
  const items = Array.from({ length: header.count }, (_, k) => read(view, HEADER + k * sizeOf(fields), fields));
  return { name: frame.name, items };
}
