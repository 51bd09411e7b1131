#!/usr/bin/env python3
"""Checks that rooms include and link only what docs/architecture.md allows.

The table under "The rooms" is the one truth: a room may know the rooms of its row and what they may
know, and of libraries from outside those of its row and of the rooms it knows. Tests beside a room
may do what the room may. Prints each line that offends; exit status 1 when there is one.
"""

import re
import sys

from checkout import parse_root, report

# Names that the table gives to families of headers and link targets.
OUTSIDE = {
    "fmt": (r"fmt/", r"fmt::"),
    "tl": (r"tl/", r"\$\{HVAS_EXPECTED"),
    "xxhash": (r"xxhash\.h", r"\$\{HVAS_XXHASH"),
    "Eigen": (r"Eigen/", r"Eigen3::"),
    "OpenCASCADE": (r"[A-Za-z0-9]+(_[A-Za-z0-9]+)?\.hxx", r"hvas_occt|\$\{HVAS_OCCT|TK[A-Z]"),
    "assimp": (r"assimp/", r"\$\{HVAS_ASSIMP"),
    "zlib": (r"zlib\.h", r"ZLIB::"),
    "nlohmann": (r"nlohmann/", r"nlohmann_json"),
    "Bullet": (r"bt[A-Z]|LinearMath/|BulletDynamics/|BulletCollision/", r"hvas_bullet|\$\{HVAS_BULLET"),
    "CLP": (r"Clp[A-Z]\w*\.hpp|Coin[A-Z]\w*\.hpp", r"hvas_clp|\$\{HVAS_CLP|\$\{HVAS_Clp"),
    "sqlite3": (r"sqlite3\.h", r"SQLite::"),
    "zstd": (r"zstd\.h", r"\$\{HVAS_ZSTD"),
    "HDF5": (r"hdf5\.h", r"\$\{HVAS_HDF5"),
    "MuJoCo": (r"mujoco/", r"\$\{HVAS_MUJOCO"),
    "CLI": (r"CLI/", r"CLI11::"),
    "Boost": (r"boost/", r"Boost::"),
    "yaml": (r"yaml-cpp/", r"\$\{HVAS_YAML"),
    "OpenSSL": (r"openssl/", r"OpenSSL::"),
}
TEST_ONLY = (r"(gtest|gmock|benchmark)/",)
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# Headers of the standard library and of POSIX; all others have to be in OUTSIDE.
STANDARD = re.compile(r"[a-z_]+|((sys|linux|net|netinet|arpa)/)?[a-z]+\.h|[a-z0-9]*intrin\.h")


def read_table(architecture):
    """Rooms and outside libraries that each room may know, direct."""
    rooms, outside = {}, {}
    for line in architecture.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        match = re.fullmatch(r"`([a-z]+)`", cells[0]) if len(cells) == 4 else None
        if not match:
            continue
        names = [[n.strip() for n in cell.split(",") if n.strip() not in ("", "-")] for cell in cells[2:]]
        rooms[match.group(1)], outside[match.group(1)] = set(names[0]), set(names[1])
    return rooms, outside


def close(rooms, outside):
    """What each room may know through others, too."""
    reach = {}

    def visit(room, path):
        if room in path:
            raise ValueError("rooms know each other in a circle: " + " -> ".join(path + [room]))
        if room not in reach:
            known = {room}
            for other in rooms[room]:
                if other not in rooms:
                    raise ValueError(f"room {room} may know {other}, which has no row")
                known |= visit(other, path + [room])
            reach[room] = known
        return reach[room]

    for room in rooms:
        visit(room, [])
    return reach, {room: set().union(*(outside[r] for r in reach[room])) for room in rooms}


def family(name, which):
    return next((f for f, patterns in OUTSIDE.items() if re.match(patterns[which], name)), None)


def check_include(room, quoted, header, is_test, rooms, reach, libraries):
    """Why this include is wrong, or None."""
    if quoted:
        other = header.split("/")[0]
        if other not in rooms:
            return f'"{header}" is in no room' if "/" in header else f'"{header}" lacks its room'
        return None if other in reach[room] else f"{room} may not know {other}"
    if STANDARD.fullmatch(header) and family(header, 0) is None:
        return None
    if any(re.match(pattern, header) for pattern in TEST_ONLY):
        return None if is_test else f"<{header}> is for tests"
    library = family(header, 0)
    if library is None:
        return f"<{header}> belongs to no library that docs/architecture.md names"
    return None if library in libraries[room] else f"{room} may not use {library}"


def check_sources(root, rooms, reach, libraries):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix not in (".h", ".cc", ".inc"):
            continue
        relative = path.relative_to(root)
        room = relative.parts[1]
        if room not in rooms:
            yield f"{relative}:1: room {room} has no row in docs/architecture.md"
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if match:
                is_test = "test" in relative.parts
                problem = check_include(room, match.group(1) == '"', match.group(2), is_test, rooms, reach, libraries)
                if problem:
                    yield f"{relative}:{number}: {problem}: {line.strip()}"


def check_links(root, rooms, reach, libraries):
    for path in sorted((root / "src").glob("*/CMakeLists.txt")):
        room = path.parent.name
        if room not in rooms:
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            code = line.split("#")[0]
            for other in re.findall(r"\bhvas(?:::|_)([a-z]+)\b", code):
                if other in rooms and other not in reach[room]:
                    yield f"{path.relative_to(root)}:{number}: {room} may not link {other}: {line.strip()}"
            for other, library in re.findall(r"\bhvas(?:::|_)([a-z]+)_([a-z_]+)\b", code):
                if other in rooms and other != room:
                    yield f"{path.relative_to(root)}:{number}: {other}_{library} is for room {other} alone: {line.strip()}"
            for word in re.split(r"[\s()]+", code):
                library = family(word, 1)
                if library and library not in libraries[room]:
                    yield f"{path.relative_to(root)}:{number}: {room} may not link {library}: {line.strip()}"


def main():
    root = parse_root(__doc__)
    rooms, outside = read_table(root / "docs" / "architecture.md")
    if not rooms:
        return report(["docs/architecture.md has no table of rooms"], "")
    reach, libraries = close(rooms, outside)
    problems = [*check_sources(root, rooms, reach, libraries), *check_links(root, rooms, reach, libraries)]
    return report(problems, f"layers: {len(rooms)} rooms include and link only what they may")


if __name__ == "__main__":
    sys.exit(main())
