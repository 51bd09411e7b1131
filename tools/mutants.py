"""Mutants of a C++ source, each a small change of it, and the choice of some of them by a seed.

A mutant is what a programmer could have written by mistake: another operator or constant, a condition the other way
round, a statement left out, the larger instead of the smaller, true for false, another sign. Sources are read as
clang-format writes them, where only binary operators stand between blanks, which tells "a < b" from "vector<int>".
"""

import dataclasses
import hashlib
import math
import re

OPERATORS = {
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",),
    "<": ("<=", ">"), "<=": ("<", ">="), ">": (">=", "<"), ">=": (">", "<="), "==": ("!=",), "!=": ("==",),
    "&&": ("||",), "||": ("&&",)}
NUMBERS = {"0": ("1",), "1": ("0", "2"), "0.0": ("1.0",), "1.0": ("0.0", "2.0")}

OPERATOR = re.compile(r"(?<=[\w)\]}] )([-+*/]=?|[<>]=?|[=!]=|&&|\|\|)(?=\s)")
NUMBER = re.compile(r"(?<![\w.'])\d[\d']*(?:\.\d*)?(?:e[-+]?\d+)?[uUlLfF]*(?![\w.'>])")
CONDITION = re.compile(r"\b(?:if|while) \(")
WORDS = re.compile(r"\b(?:(?:true|false)\b|std::(?:min|max)\()")
SIGN = re.compile(r"(?:(?<=[(\[{])|(?<=[(,=?:] )|(?<=return ))-(?=[\w(])")
NEGATION = re.compile(r"!(?=[\w(*])")
# On a line of its own: a call whose result is not used, or an assignment to what is declared elsewhere.
CALL = re.compile(r" *[\w:.\[\]>()*-]+\(.*\);")
ASSIGNMENT = re.compile(r" *[\w:.\[\]>()*-]+ (?:[-+*/|&^]|<<|>>)?= .*;| *(?:\+\+|--)[\w.>\[\]-]+;")
NO_STATEMENT = re.compile(r" *(?:return|break|continue|case|delete|throw|co_\w+|static_assert|using|HVAS_ASSERT)\b")
RESERVE = re.compile(r"(?:\.|->)(?:reserve|shrink_to_fit)\(")  # Time and memory only.

# What is no code: preprocessor lines, comments, texts and characters; and assertions, which only builds with sanitizers
# compile. A group stays as it is: the quote of a number's digits.
NO_CODE = re.compile(
    r'^[ \t]*#(?:[^\n\\]|\\.|\\\n)*|//[^\n]*|/\*.*?\*/|R"(?P<end>[^(\s]*)\(.*?\)(?P=end)"|"(?:[^"\\\n]|\\.)*"'
    r"|(?P<digits>(?<=\d)'(?=\d))|'(?:[^'\\\n]|\\.)*'|\bHVAS_ASSERT\([^;]*;", re.DOTALL | re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Mutant:
    file: str        # From the folder of the project.
    number: int      # Of its first line, from 1.
    line: str        # That line, without the blanks around it.
    mutated: str     # The line as it is mutated, likewise.
    occurrence: int  # Of lines of the file that are equal, which it is, from 1.
    kind: str
    text: str        # The whole source, mutated.

    @property
    def key(self):
        """What stays when something else of the file changes."""
        return (self.file, self.line, self.mutated, self.occurrence)


def blank(text):
    """The text with blanks for all that is no code; lines stay where they are."""
    return NO_CODE.sub(lambda m: m[0] if m["digits"] else re.sub(r"[^\n]", " ", m[0]), text)


def find_close(code, begin):
    """Where the parenthesis that opens at `begin` closes; None where it does not."""
    depth = 0
    for at in range(begin, len(code)):
        depth += {"(": 1, ")": -1}.get(code[at], 0)
        if depth == 0:
            return at
    return None


def find_edits(text):
    """Yields of each mutant its kind and what it replaces: begin, end, replacement; one or two of them, in order."""
    code = blank(text)
    for m in OPERATOR.finditer(code):
        for other in OPERATORS[m[1]]:
            yield "operator", ((*m.span(1), other),)
    for m in NUMBER.finditer(code):
        for other in NUMBERS.get(m[0], (f"(2 * {m[0]})",)):
            yield "constant", ((*m.span(), other),)
    for m in CONDITION.finditer(code):
        close = find_close(code, m.end() - 1)
        if close is not None:
            # After an initializer, if there is one: if (auto found = Find(); found).
            begin = code.rfind("; ", m.end(), close)
            begin = m.end() if begin < 0 else begin + 2
            # A declaration has no opposite, and that of !a is found below.
            if not re.match(r"const |auto ", code[begin:]) and not re.fullmatch(r"!\w+", code[begin:close]):
                yield "condition", ((begin, begin, "!("), (close, close, ")"))
    for m in NEGATION.finditer(code):
        yield "condition", ((*m.span(), ""),)
    for m in WORDS.finditer(code):
        other = {"true": "false", "false": "true", "std::min(": "std::max(", "std::max(": "std::min("}[m[0]]
        yield ("min or max" if "::" in m[0] else "truth"), ((*m.span(), other),)
    for m in SIGN.finditer(code):
        yield "sign", ((*m.span(), ""),)
    before = "{"
    for m in re.finditer(r"[^\n]+", code):
        line = m[0].rstrip()
        is_whole = line.count("(") == line.count(")") and line.count("{") == line.count("}")
        if (before in ";{}:" and is_whole and not NO_STATEMENT.match(line) and not RESERVE.search(line)
                and (CALL.fullmatch(line) or ASSIGNMENT.fullmatch(line))):
            begin = m.start() + len(line) - len(line.lstrip())
            yield "statement", ((begin, m.start() + len(line), ";"),)
        before = line.strip()[-1:] or before


def list_mutants(file, text):
    """All mutants of a source, as they stand in it."""
    lines = text.split("\n")
    starts = [0]
    seen = {}
    occurrences = []
    for line in lines:
        starts.append(starts[-1] + len(line) + 1)
        seen[line.strip()] = seen.get(line.strip(), 0) + 1
        occurrences.append(seen[line.strip()])
    mutants = []
    for kind, edits in find_edits(text):
        mutated = text
        for begin, end, replacement in reversed(edits):
            mutated = mutated[:begin] + replacement + mutated[end:]
        index = text.count("\n", 0, edits[0][0])
        line = lines[index].strip()
        mutants.append(Mutant(file, index + 1, line, mutated.split("\n")[index].strip(), occurrences[index], kind, mutated))
    return sorted(mutants, key=lambda mutant: (mutant.number, mutant.mutated))


def draw(mutants, seed):
    """The mutants in the random order of a seed. A line with many of them, as of a table, is drawn no more often than one
    with a single one. What the order is of two of them depends on them alone, so that it stays when others change."""
    on_line = {}
    for mutant in mutants:
        place = (mutant.file, mutant.line, mutant.occurrence)
        on_line[place] = on_line.get(place, 0) + 1

    def rank(mutant):
        digest = hashlib.sha256(repr((seed, mutant.key)).encode()).digest()
        uniform = (int.from_bytes(digest[:8], "big") + 1) / (2**64 + 1)
        # Efraimidis and Spirakis, Information Processing Letters 97, 2006: a weighted sample without replacement.
        return -math.log(uniform) * on_line[mutant.file, mutant.line, mutant.occurrence]

    return sorted(mutants, key=rank)
