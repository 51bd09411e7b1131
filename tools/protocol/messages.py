"""JSON messages of src/studio/protocol.json, as TypeScript types, C++ readers of commands, and tables of a page."""

import re

PRIMITIVES = {"text": "string", "flag": "boolean", "number": "number", "whole": "number", "index": "number",
              "hand": "number", "null": "null"}
# C++ type of a command's field, and the function of studio/json_fields.h that reads it.
CPP = {"text": ("std::string", "TextAt"), "flag": ("bool", "FlagAt"), "index": ("std::uint32_t", "IndexAt"),
       "index[]": ("std::vector<product::OccurrenceId>", "OccurrencesAt"),
       "hand": ("std::size_t", "HandAt"), "number": ("double", "NumberAt"), "FaceOf": ("PickedFace", "FaceAt"),
       "Vec3": ("Vec3", "Vec3At"),
       "AnswerValue": ("study::AnswerValue", "AnswerAt")}
RIGHTS = {"lease": "kLease", "hand": "kHand", "operator": "kOperator", "owner": "kOwner", "anybody": "kAnybody"}
MARKS = ("<!-- {} of protocol.json -->", "<!-- end of {} -->")


MADE = "// Made from protocol.json by tools/protocol/generate.py."


def cpp_head(*includes):
    """The first lines of a generated header."""
    return [MADE, "#pragma once", "", *(f"#include <{name}>" for name in includes), ""]


def alternatives(kind):
    return [one.strip() for one in kind.split("|")]


def words_of(kind):
    """The words of a type that is nothing but words; none of any other."""
    names = alternatives(kind)
    return [name.strip("'") for name in names] if all(name.startswith("'") for name in names) else []


def parts_of(one):
    """Name and form of one alternative: "T", "T[]", "T[3]" or "{T}"."""
    found = re.fullmatch(r"(\w+)(\[\d*\])?|\{(\w+)\}", one)
    if not found:
        raise SystemExit(f"{one}: no type")
    return (found[3], "{}") if found[3] else (found[1], found[2] or "")


class Field:
    """A field as protocol.json describes it: "type", ["type", "about"] or an object."""

    def __init__(self, key, told):
        self.name = key.rstrip("?")
        self.is_optional = key.endswith("?")
        told = told if isinstance(told, dict) else dict(zip(("type", "about"), [told] if isinstance(told, str) else told))
        self.kind = told["type"]
        self.about = told.get("about", "")
        self.told = told


def fields_of(item):
    return [Field(key, told) for key, told in item.get("fields", {}).items()]


def alias_of(told):
    """Type and meaning of a name that stands for another type; nothing for an object."""
    if isinstance(told, dict):
        return None
    return (told, "") if isinstance(told, str) else told


def all_types(schema):
    for told in schema["types"].values():
        alias = alias_of(told)
        if alias:
            yield alias[0]
    groups = [told for told in schema["types"].values() if isinstance(told, dict)]
    groups += schema["commands"] + schema["study_actions"] + schema["events"]
    for group in groups:
        yield from (field.kind for field in fields_of(group))
        yield from (group[key] for key in ("base", "result") if key in group)


def check(schema):
    """Every type has a name, and every command a right that there is."""
    for kind in all_types(schema):
        for one in alternatives(kind):
            if not one.startswith("'") and parts_of(one)[0] not in {*PRIMITIVES, *schema["types"]}:
                raise SystemExit(f"{one}: there is no such type")
    for command in schema["commands"]:
        if command["right"] not in RIGHTS:
            raise SystemExit(f"{command['name']}: there is no right {command['right']}")


# TypeScript


def ts_one(one):
    if one.startswith("'"):
        return '"' + one.strip("'") + '"'
    name, form = parts_of(one)
    name = PRIMITIVES.get(name, name)
    if form == "{}":
        return f"Readonly<Record<string, {name}>>"
    if form == "[]":
        return f"readonly {name}[]"
    return "readonly [" + ", ".join([name] * int(form[1:-1])) + "]" if form else name


def ts_type(kind):
    return " | ".join(ts_one(one) for one in alternatives(kind))


def ts_about(about, indent, lines):
    if about:
        lines.append(f"{indent}/** {about[0].upper()}{about[1:]}{'' if about.endswith('.') else '.'} */")


def ts_fields(item, lines, mark=""):
    for field in fields_of(item):
        ts_about(field.about, "  ", lines)
        lines.append(f"  {field.name}{'?' if field.is_optional else mark}: {ts_type(field.kind)};")


def ts_name(name, told, lines):
    alias = alias_of(told)
    if alias:
        ts_about(alias[1], "", lines)
        lines += [f"export type {name} = {ts_type(alias[0])};", ""]
        if words_of(alias[0]):
            words = ", ".join(f'"{word}"' for word in words_of(alias[0]))
            lines += [f"export const k{name}s: readonly {name}[] = [{words}];", ""]
        return
    ts_about(told.get("about"), "", lines)
    base = told.get("base")
    if base:
        own = " | ".join(f'"{field.name}"' for field in fields_of(told))
        base = f"Partial<{base}>" if told.get("is_partial") else base
        lines.append(f"export interface {name} extends Omit<{base}, {own}> {{")
    else:
        lines.append(f"export interface {name} {{")
    ts_fields(told, lines)
    lines += ["}", ""]


def ts_member(key, item):
    """One line of a union: {"command": "take", ...}."""
    inside = "".join(f"; {field.name}{'?' if field.is_optional else ''}: {ts_type(field.kind)}" for field in fields_of(item))
    return f'{{ {key}: "{item["name"]}"{inside} }}'


def make_ts(schema):
    lines = [MADE, ""]
    for name, told in schema["types"].items():
        ts_name(name, told, lines)
    lines.append('export type StudyCommand = { command: "study" } & (')
    lines += [f"  | {ts_member('action', action)}" for action in schema["study_actions"]]
    lines += [");", "", "/** What a client asks for. By the \"id\" of the message the answer is known. */", "export type Command ="]
    lines += [f"  | {ts_member('command', command)}" for command in schema["commands"] if "actions" not in command]
    lines += ["  | StudyCommand;", "", "/** What each command is answered with. */", "export interface CommandResults {"]
    for command in schema["commands"]:
        result = ts_type(command["result"]) if "result" in command else "Record<string, never>"
        lines.append(f"  {command['name']}: {result};")
    lines += ["}", "", "/** What the server tells without being asked. */", "export type ServerEvent ="]
    for event in schema["events"]:
        ts_about(event["about"], "  ", lines)
        base = f" & {event['base']}" if "base" in event else ""
        lines.append(f"  | ({ts_member('event', event)}{base})" if base else f"  | {ts_member('event', event)}")
    lines[-1] += ";"
    return "\n".join(lines) + "\n"


# C++


def camel(name):
    return "".join(part[0].upper() + part[1:] for part in name.split("_"))


def without_null(kind):
    names = [one for one in alternatives(kind) if one != "null"]
    return " | ".join(names), len(names) < len(alternatives(kind))


def cpp_words(schema, name):
    told = schema["types"].get(name)
    return words_of(told) if isinstance(told, str) else []


def cpp_literal(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else str(value)


def cpp_member(schema, field):
    kind, _ = without_null(field.kind)
    kept = kind if cpp_words(schema, kind) else CPP[kind][0]
    if field.is_optional and "missing" not in field.told and kind != "AnswerValue":
        return f"std::optional<{kept}> {field.name};"
    initial = {"bool": "{false}", "std::uint32_t": "{0}", "std::size_t": "{0}", "double": "{0}"}.get(kept, "")
    initial = "{}" if cpp_words(schema, kind) else initial
    if field.told.get("missing", "") != "":
        initial = "{" + cpp_literal(field.told["missing"]) + "}"
    return f"{kept} {field.name}{initial};"


def cpp_reader(schema, field):
    kind, may_be_null = without_null(field.kind)
    arguments = f'json, "{field.name}"'
    if cpp_words(schema, kind):
        reader, arguments = f"WordAt<{kind}>", f"{arguments}, k{kind}s"
    else:
        reader = CPP[kind][1]
    if kind == "number":
        arguments += f", {{{field.told['low']}, {field.told['high']}}}"
    if kind == "text" and "longest" in field.told:
        arguments += f", {field.told['longest']}"
    read = f"first.Keep({reader}({arguments}), &fields.{field.name});"
    if not field.is_optional:
        return [f"  {read}"]
    present = "HasValue" if may_be_null else "HasField"
    return [f'  if ({present}(json, "{field.name}")) {{', f"    {read}", "  }"]


def cpp_struct(schema, name, about, constants, item, lines):
    lines += [f"/** {about} */", f"struct {name} {{"]
    lines += [f"  static constexpr {constant};" for constant in constants]
    lines += [f"  {cpp_member(schema, field)}" for field in fields_of(item)]
    lines += ["};", ""]
    if not fields_of(item):
        lines += ["template <>", f"inline Result<{name}> ReadFields<{name}>(const Json&) {{", f"  return {name}{{}};", "}", ""]
        return
    lines += ["template <>", f"inline Result<{name}> ReadFields<{name}>(const Json& json) {{", f"  {name} fields;",
              "  FirstError first;"]
    for field in fields_of(item):
        lines += cpp_reader(schema, field)
    lines += ["  return first.Or(&fields);", "}", ""]


def cpp_enums(schema, lines):
    groups = schema["commands"] + schema["study_actions"]
    used = {without_null(field.kind)[0] for group in groups for field in fields_of(group)}
    for name in schema["types"]:
        words = cpp_words(schema, name)
        if name in used and words:
            members = ", ".join("k" + camel(word) for word in words)
            listed = ", ".join(f'"{word}"' for word in words)
            lines += [f"enum class {name} : std::uint8_t {{ {members} }};",
                      f"inline constexpr std::array<const char*, {len(words)}> k{name}s{{{listed}}};", ""]


def cpp_study_rules(schema, lines):
    rules = schema["study_actions"]
    lines += ["/** Who may send an action of the command `study`. */", "struct StudyRule {", "  const char* action;",
              "  bool is_for_participant, is_for_experimenter, is_for_viewer;", "};", "",
              f"inline constexpr std::array<StudyRule, {len(rules)}> kStudyRules{{{{"]
    for rule in rules:
        who = ", ".join(str(mark in rule["who"]).lower() for mark in "pev")
        lines.append(f'    {{"{rule["name"]}", {who}}},')
    lines += ["}};", ""]


def make_cpp(schema):
    lines = [
        *cpp_head("array", "cstdint", "optional", "string", "utility", "vector"),
        '#include "studio/json_fields.h"',
        "",
        "namespace hvas::studio::protocol {",
        "",
        "/** Who may send a command. */",
        "enum class Right : std::uint8_t {",
        "  kLease,     ///< The client with the lease of hand 0.",
        "  kHand,      ///< The client with the lease of the hand that the command names.",
        "  kOperator,  ///< An operator.",
        "  kOwner,     ///< The owner of the studio (Visitor::is_owner).",
        "  kAnybody,",
        "};",
        "",
    ]
    cpp_enums(schema, lines)
    lines += ["/** Reads a command. Errors (kInvalid) name the first field that is wrong and what it should be. */",
              "template <typename Fields>", "Result<Fields> ReadFields(const Json& json);", ""]
    for command in schema["commands"]:
        constants = [f'const char* kName = "{command["name"]}"', f"Right kRight = Right::{RIGHTS[command['right']]}"]
        cpp_struct(schema, camel(command["name"]) + "Command", f"The command `{command['name']}`.", constants, command, lines)
    for action in schema["study_actions"]:
        if fields_of(action):
            cpp_struct(schema, camel(action["name"]) + "Action", f"The action `{action['name']}` of the command `study`.", [],
                       action, lines)
    cpp_study_rules(schema, lines)
    lines += ["}  // namespace hvas::studio::protocol", ""]
    return "\n".join(lines)


# Tables


def told_type(kind):
    """A type as a page says it: "a", "b" or null."""
    names = [one.replace("'", '"') for one in alternatives(kind)]
    return ", ".join(names[:-1]) + (" or " if names[1:] else "") + names[-1]


def page_field(field):
    told = ["" if field.kind == "text" else told_type(field.kind)]
    told += [f"{field.told['low']} to {field.told['high']}"] if "low" in field.told else []
    told += [f"at most {field.told['longest']} characters"] if "longest" in field.told else []
    told += [f"{cpp_literal(field.told['missing'])} when missing"] if field.told.get("missing", "") != "" else []
    told += [field.about.replace("; ", ", ")]
    text = ", ".join(one for one in told if one)
    return f"`{field.name}{'?' if field.is_optional else ''}`" + (f": {text}" if text else "")


def row(*cells):
    return "| " + " | ".join(cells) + " |"


def page_fields(item):
    told = [f"those of {item['base']}"] if "base" in item else []
    told += [page_field(field) for field in fields_of(item)]
    return "; ".join(told)


def page_commands(schema):
    lines = ["| command | fields | does | result |", "|---|---|---|---|"]
    for command in schema["commands"]:
        mark = schema["rights"][command["right"]]
        lines.append(row(f"`{command['name']}` {mark}".strip(), page_fields(command), command["about"],
                         told_type(command["result"]) if "result" in command else ""))
    return lines


def page_events(schema):
    lines = ["| event | tells | fields |", "|---|---|---|"]
    return lines + [row(f"`{event['name']}`", event["about"], page_fields(event)) for event in schema["events"]]


def page_actions(schema):
    names = {"p": "p", "e": "e", "v": "viewers"}
    lines = ["| action | who | fields | does |", "|---|---|---|---|"]
    for action in schema["study_actions"]:
        who = ", ".join(names[mark] for mark in action["who"])
        lines.append(row(f"`{action['name']}`", who, page_fields(action), action["about"]))
    return lines


def page_types(schema):
    lines = ["| type | is | fields |", "|---|---|---|"]
    for name, told in schema["types"].items():
        alias = alias_of(told)
        if alias:
            lines.append(row(name, told_type(alias[0]) + (f": {alias[1]}" if alias[1] else ""), ""))
        else:
            about = told.get("about", "") + (" Any may be missing." if told.get("is_partial") else "")
            lines.append(row(name, about.strip(), page_fields(told)))
    return lines


def write_tables(schema, page):
    """The text of a page, with the tables between its marks made anew."""
    tables = {"commands": page_commands, "events": page_events, "study_actions": page_actions, "types": page_types}
    for name, make in tables.items():
        begin, end = (mark.format(name) for mark in MARKS)
        if page.count(begin) != 1 or page.count(end) != 1:
            raise SystemExit(f"the page has no marks {begin} ... {end}")
        before, _, rest = page.partition(begin)
        _, _, after = rest.partition(end)
        page = "\n".join([before + begin, "", *make(schema), "", end]) + after
    return page
