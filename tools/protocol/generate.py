#!/usr/bin/env python3
"""Makes of src/studio/protocol.json what the studio's client and server say to each other.

  generate.py cpp SCHEMA OUT.h           frames: packed structs, their sizes checked by the compiler
  generate.py ts SCHEMA OUT.ts           frames: readers and writers over DataView
  generate.py golden SCHEMA FOLDER       frames: one of each kind with known numbers, for the tests of both
  generate.py commands SCHEMA OUT.h      commands: their fields as structs, with what reads them from JSON
  generate.py messages SCHEMA OUT.ts     commands, events and what they are made of, as types
  generate.py docs SCHEMA PAGE [--check] tables of a page, between its marks; --check only tells
"""

import json
import pathlib
import struct
import sys

import messages

CPP = {"u16": "std::uint16_t", "u32": "std::uint32_t", "i64": "std::int64_t", "f32": "float"}
SIZE = {"u16": 2, "u32": 4, "i64": 8, "f32": 4}
PACK = {"u16": "H", "u32": "I", "i64": "q", "f32": "f"}
TS_GET = {"u16": "getUint16", "u32": "getUint32", "i64": "getBigInt64", "f32": "getFloat32"}
TS_SET = {key: get.replace("get", "set") for key, get in TS_GET.items()}


def size_of(fields):
    return sum(SIZE[kind] * count for _, kind, count in fields)


def check(schema):
    """Every field at a multiple of its size, every item a multiple of four bytes."""
    for name, fields in [("header", schema["header"]), *schema["items"].items()]:
        at = 0
        for field, kind, count in fields:
            if at % min(SIZE[kind], 8) != 0:
                raise SystemExit(f"{name}.{field} lies at {at}, no multiple of {SIZE[kind]}")
            at += SIZE[kind] * count
        if at % 4 != 0:
            raise SystemExit(f"{name} has {at} bytes, no multiple of 4")


def cpp_struct(name, fields, lines):
    lines.append(f"struct {name} {{")
    for field, kind, count in fields:
        member = f"std::array<{CPP[kind]}, {count}> {field}{{}};" if count > 1 else f"{CPP[kind]} {field}{{}};"
        lines.append(f"  {member}")
    lines.append("};")
    lines.append(f"static_assert(sizeof({name}) == {size_of(fields)});")
    lines.append(f"static_assert(std::is_trivially_copyable_v<{name}>);")
    lines.append("")


def make_cpp(schema):
    magic = struct.unpack("<I", schema["magic"].encode())[0]
    lines = [
        *messages.cpp_head("array", "cstdint", "type_traits"),
        "namespace hvas::studio::protocol {",
        "",
        f"inline constexpr std::uint32_t kMagic = {magic:#x};",
        f"inline constexpr std::uint16_t kVersion = {schema['version']};",
    ]
    for name, value in schema["constants"].items():
        lines.append(f"inline constexpr std::uint32_t {name} = {value:#x};")
    lines += ["", "enum class FrameKind : std::uint16_t {"]
    lines += [f"  k{frame['name']} = {frame['kind']}," for frame in schema["frames"]]
    lines += ["};", ""]
    cpp_struct("Header", schema["header"], lines)
    for name, fields in schema["items"].items():
        cpp_struct(name, fields, lines)
    lines.append("/** The kind of the frame whose items are of type Item. */")
    lines.append("template <typename Item>")
    lines.append("inline constexpr FrameKind kKindOf{};")
    for frame in schema["frames"]:
        lines.append("template <>")
        lines.append(f"inline constexpr FrameKind kKindOf<{frame['item']}> = FrameKind::k{frame['name']};")
    lines += ["", "}  // namespace hvas::studio::protocol", ""]
    return "\n".join(lines)


def ts_type(kind, count):
    if count > 1:
        return "readonly number[]"
    return "bigint" if kind == "i64" else "number"


def ts_access(fields, start="at"):
    """For each field: name, kind, count and its offset as text."""
    at = 0
    for field, kind, count in fields:
        yield field, kind, count, f"{start} + {at}" if at else start, at
        at += SIZE[kind] * count


def ts_item(name, fields, lines):
    lines.append(f"export interface {name} {{")
    lines += [f"  {field}: {ts_type(kind, count)};" for field, kind, count in fields]
    lines += ["}", ""]
    lines.append(f"export const {name}Size = {size_of(fields)};")
    lines.append("")
    lines.append(f"export function read{name}(view: DataView, at: number): {name} {{")
    lines.append("  return {")
    for field, kind, count, where, at in ts_access(fields):
        endian = ", true"
        if count > 1:
            parts = ", ".join(f"view.{TS_GET[kind]}(at + {at + SIZE[kind] * k}{endian})" for k in range(count))
            lines.append(f"    {field}: [{parts}],")
        else:
            lines.append(f"    {field}: view.{TS_GET[kind]}({where}{endian}),")
    lines += ["  };", "}", ""]
    lines.append(f"export function write{name}(view: DataView, at: number, item: {name}): void {{")
    for field, kind, count, where, at in ts_access(fields):
        if count > 1:
            lines.append(f"  for (let k = 0; k < {count}; k++) {{")
            lines.append(f"    view.{TS_SET[kind]}(at + {at} + {SIZE[kind]} * k, item.{field}[k] ?? 0, true);")
            lines.append("  }")
        else:
            lines.append(f"  view.{TS_SET[kind]}({where}, item.{field}, true);")
    lines += ["}", ""]


def make_ts(schema):
    magic = struct.unpack("<I", schema["magic"].encode())[0]
    lines = [
        messages.MADE,
        "",
        f"export const kMagic = {magic:#x};",
        f"export const kVersion = {schema['version']};",
    ]
    lines += [f"export const {name} = {value:#x};" for name, value in schema["constants"].items()]
    lines += ["", "export const FrameKind = {"]
    lines += [f"  {frame['name']}: {frame['kind']}," for frame in schema["frames"]]
    lines += ["} as const;", ""]
    ts_item("Header", schema["header"], lines)
    for name, fields in schema["items"].items():
        ts_item(name, fields, lines)
    return "\n".join(lines)


def golden_values(fields, start):
    """Known numbers that every float holds exactly: start, start + 0.5, start + 1, ..."""
    values = []
    for _, kind, count in fields:
        for _ in range(count):
            number = start + 0.5 * len(values)
            values.append(number if kind == "f32" else int(number))
    return values


def pack(fields, values):
    return struct.pack("<" + "".join(PACK[kind] * count for _, kind, count in fields), *values)


def make_golden(schema, frame):
    fields = schema["items"][frame["item"]]
    count = 2
    size = size_of(schema["header"]) + count * size_of(fields)
    magic = struct.unpack("<I", schema["magic"].encode())[0]
    header = pack(schema["header"], [magic, schema["version"], frame["kind"], size, 7, 3, count, 1_234_567_890_123])
    return header + b"".join(pack(fields, golden_values(fields, 1 + 100 * i)) for i in range(count))


def update_page(schema, page, only_tells):
    before = page.read_text()
    after = messages.write_tables(schema, before)
    if before == after:
        return
    if only_tells:
        raise SystemExit(f"{page}: tables are not those of the schema; mend them with\n"
                         f"  tools/protocol/generate.py docs src/studio/protocol.json {page}")
    page.write_text(after)


def write_golden(schema, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for frame in schema["frames"]:
        (folder / f"{frame['name'].lower()}.bin").write_bytes(make_golden(schema, frame))


MAKERS = {"cpp": make_cpp, "ts": make_ts, "commands": messages.make_cpp, "messages": messages.make_ts}


def main(arguments):
    only_tells = arguments[3:] == ["--check"] and arguments[0] == "docs"
    if len(arguments) != (4 if only_tells else 3) or arguments[0] not in (*MAKERS, "golden", "docs"):
        raise SystemExit(__doc__)
    what, source, target = arguments[0], arguments[1], pathlib.Path(arguments[2])
    schema = json.loads(pathlib.Path(source).read_text())
    check(schema)
    messages.check(schema)
    if what == "docs":
        update_page(schema, target, only_tells)
    elif what == "golden":
        write_golden(schema, target)
    else:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(MAKERS[what](schema))


if __name__ == "__main__":
    main(sys.argv[1:])
