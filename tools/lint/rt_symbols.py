#!/usr/bin/env python3
"""Checks that the haptic tick allocates, locks, throws and prints nothing.

Two ways, both on the object files of an optimised build, rt_symbols.py BUILD_FOLDER:

1. Object files that hold nothing but real-time code may not even name a forbidden symbol (nm).
2. Other files hold set-up code beside the tick's. There every function that can be reached from the
   tick's entry points by direct calls, jumps or taken addresses is followed over all rooms
   (objdump), and the chain of calls is printed where it ends in a forbidden symbol.

Calls through pointers cannot be followed; the targets of virtual calls in the tick have to be named
as roots below. Needs functions that were not stripped of relocations, hence object files.
"""

import collections
import multiprocessing
import pathlib
import re
import subprocess
import sys

FORBIDDEN = re.compile(
    r"operator (new|delete)|^(malloc|calloc|realloc|free|aligned_alloc|posix_memalign)$|__cxa_throw|"
    r"__cxa_allocate_exception|std::__throw_|pthread_(mutex|cond|rwlock|create)|basic_ostream|^fmt::|"
    r"^(printf|fprintf|puts|fputs|fwrite|write|fopen|open|usleep|nanosleep)$|__cxa_guard_acquire|_Unwind_Resume"
)

# Hold nothing but real-time code: room/file.
TICK_ONLY = """
    contact/kernel_avx2 contact/kernel_scalar contact/pool contact/query contact/reduce contact/refine contact/slide
    haptics/buzz_detector haptics/constraint_solver haptics/force_map haptics/kick_detector haptics/mate_guide
    haptics/passivity_controller haptics/safety_gate haptics/thermal_limit haptics/workspace
    haptics/write_pace
    mates/capture mates/resolve spatial/pose spatial/surface
""".split()

# Entry points in files that hold set-up code too, as regular expressions of whole demangled names.
ROOTS = [
    r"hvas::simulation::HapticSide::Tick\(.*",
    r"hvas::person::SimulatedPerson::Step\(.*",  # virtual: the operator of a headless run
    r"hvas::person::SimulatedPerson::Intend\(.*",
    r"hvas::simulation::DeviceOperator::(Step|Apply)\(.*",
    # Virtual: Device::Read and Device::Write of every driver.
    r"hvas::device::(\(anonymous namespace\)::)?\w+::(Read\(\)|Write\(hvas::spatial::Wrench const&\))",
    r"hvas::device::\(anonymous namespace\)::(Hd|Dhd|Virt)Device::(ReadVendor|WriteVendor|Tick)\(.*",
    r"hvas::device::SampleGuard::\w+\(.*",
    r"hvas::simulation::FlightRecorder::(Keep|Trigger)\(.*",
    r"hvas::\(anonymous namespace\)::MachineLoopClock::NowNs\(.*",  # virtual: the clock of a live loop
    r"hvas::simulation::PartRun::OnTick\(.*",  # virtual: the sink of every run
    r"hvas::session::SessionRecorder::OnTick\(.*",  # virtual: the sink that records
    r"hvas::study::TrialWatch::OnTick\(.*",  # virtual: the account of a trial
    r"hvas::studio::(LiveRun|LiveTrial|Recording)::OnTick\(.*",  # virtual: the sinks of a live run
    r"hvas::studio::PointerOperator::(Step|Intend)\(.*",  # virtual: the operator of a page
    r"hvas::haptics::HapticTick::(Tick|Take|Drop)\(.*",
    r"hvas::contact::Scene::(Query|IsFree|SetPose|SetEnabled)\(.*",
    r"hvas::fits::FitForce::Calc\w+\(.*",
]

# Not followed: reason beside each.
EXEMPT = [
    r"std::terminate\(\)",  # the end of a noexcept function that was never to throw
    r"hvas::record::Recorder::AddTick\(",  # threaded it pushes to a ring; only in virtual time it writes itself
    r"hvas::contact::BodyTree::Remove\(",  # pushes to a list for which Reserve has made room
]
EXEMPT_CALLS = re.compile("|".join(EXEMPT))


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def demangle(names):
    names = list(names)
    text = subprocess.run(["c++filt"], input="\n".join(names), check=True, capture_output=True, text=True).stdout
    return dict(zip(names, text.split("\n")))


def find_objects(build):
    """Object files of the rooms' libraries by room/library/file; most hold several sources."""
    objects = {}
    for path in sorted((build / "src").glob("*/CMakeFiles/hvas_*.dir/**/*.o")):
        room, _, library, *inner = path.relative_to(build / "src").parts[:-1]
        folders = "/".join([room, library.removesuffix(".dir"), *inner])
        objects[f"{folders}/{path.name.split('.')[0]}"] = path
    return objects


def check_tick_only(objects):
    for name in TICK_ONLY:
        room, file = name.split("/")
        name = f"{room}/hvas_{room}/{file}"
        if name not in objects:
            yield f"{name}: no such object file; is the list in tools/lint/rt_symbols.py out of date?"
            continue
        for line in run("nm", "-uC", str(objects[name])).splitlines():
            symbol = line.strip().split(" ", 1)[-1].strip()
            if FORBIDDEN.search(symbol):
                yield f"{name}.cc names {symbol}"


def read_calls(path):
    """Function -> symbols that it refers to, of one object file; file-local ones made unique."""
    local, starts = set(), collections.defaultdict(list)
    for line in run("objdump", "-t", str(path)).splitlines():
        match = re.match(r"([0-9a-f]+) (.{7}) (\S+)\s+[0-9a-f]+\s+(?:\.hidden )?(.+)$", line)
        if match and "F" in match.group(2):
            address, flags, section, name = match.groups()
            starts[section].append((int(address, 16), name))
            if flags[0] == "l":
                local.add(name)
    for functions in starts.values():
        functions.sort()

    def at(section, offset):
        """The function that holds this offset of a section; other sections are data."""
        found = [name for start, name in starts.get(section, []) if start <= offset]
        return found[-1] if found else None

    def unique(name):
        return f"{name}@{path}" if name in local else name

    calls, current = collections.defaultdict(set), None
    lines = run("objdump", "-dr", "--no-show-raw-insn", str(path)).splitlines()
    relocation = re.compile(r"\s+[0-9a-f]+: R_\S+\s+(\S+)")
    for line, following in zip(lines, [*lines[1:], ""]):
        if match := re.match(r"[0-9a-f]+ <(.+)>:$", line):
            current = unique(match.group(1))
            calls[current]  # present even when it calls nothing
        elif match := relocation.match(line):
            symbol, offset = re.fullmatch(r"(.+?)(?:([+-])0x([0-9a-f]+))?", match.group(1)).group(1, 3)
            if symbol.startswith(".text"):
                # Relative to the next instruction: four bytes on.
                target = at(symbol, int(offset or "0", 16) + 4)
                if target:
                    calls[current].add(unique(target))
            else:
                calls[current].add(unique(symbol))
        elif relocation.match(following):
            continue  # its own operand is only a place holder
        elif match := re.search(r"\b(?:call|j\w+)\s+[0-9a-f]+ <([^+>]+)(?:\+0x[0-9a-f]+)?>$", line):
            if unique(match.group(1)) != current:
                calls[current].add(unique(match.group(1)))
    return calls


def check_reachable(objects):
    calls = collections.defaultdict(set)
    with multiprocessing.Pool() as pool:
        for read in pool.imap(read_calls, objects.values()):
            for function, targets in read.items():
                calls[function] |= targets
    plain = demangle({n.split("@/")[0] for f, ts in calls.items() for n in (f, *ts)})

    def pretty(name):
        return plain[name.split("@/")[0]]

    before, queue = {}, collections.deque()
    for root in ROOTS:
        matches = [f for f in calls if re.fullmatch(root, pretty(f)) and "[clone .cold]" not in pretty(f)]
        if not matches:
            yield f"no function is called {root}; is the list in tools/lint/rt_symbols.py out of date?"
        for function in matches:
            if function not in before:
                before[function] = None
                queue.append(function)
    while queue:
        function = queue.popleft()
        for target in sorted(calls.get(function, ())):
            if target in before or EXEMPT_CALLS.search(pretty(target)):
                continue
            before[target] = function
            if FORBIDDEN.search(pretty(target)):
                chain, at = [], target
                while at is not None:
                    chain.append(pretty(at))
                    at = before[at]
                yield "\n    ".join(["reached from the tick:", *reversed(chain)])
            else:
                queue.append(target)
    print(f"rt_symbols: {len(TICK_ONLY)} object files, {len(before)} functions reached from {len(ROOTS)} roots")


def main():
    if len(sys.argv) != 2:
        print("usage: rt_symbols.py BUILD_FOLDER", file=sys.stderr)
        return 2
    objects = find_objects(pathlib.Path(sys.argv[1]))
    problems = [*check_tick_only(objects), *check_reachable(objects)]
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
