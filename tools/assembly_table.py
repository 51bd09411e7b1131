#!/usr/bin/env python3
"""How far a folder of CAD files can be assembled: one row a product, and each part that is not in its place with its cause.

  tools/assembly_table.py HVAS FOLDER [--seeds 1,2,3] [--limit 300] [--match WORDS] [--parts 2-150] [--write FILE]

Every CAD file is a product, and so is every folder of mesh files. `hvas inspect` reads it into an empty cache and counts
its parts; with a number of parts within --parts, `hvas assemble` assembles it with each seed. A process that takes more
than --limit seconds of processor time is ended by SIGTERM, and what it did until then counts. With several seeds, a second
table has the parts that are not in their places with every seed alike. --write keeps all answers as JSON.

Columns: left out and give way count the pairs of parts that lie in one another as drawn; beyond drawn is the deepest that a
part in the hand lay in another one, less what the two do as drawn. Import is the processor time of `hvas inspect`,
preparation that of `hvas assemble` besides its run; memory is the peak of all processes. Exit status 1 when a product that
can be read gives no answer.
"""

import argparse
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

MESHES = {".obj", ".stl", ".ply", ".off"}
FILES = {".step", ".stp", ".igs", ".iges", ".gltf", ".glb", ".3mf"}
HEAD = ["product", "seed", "in place", "whole", "untouched", "left out, give way", "beyond drawn mm", "import, preparation, run CPU s",
        "session s", "MB", "ended"]
# The pairs in the notes of `hvas assemble`: each has the deepest of a part's overlaps, and how many more there are.
OVERLAP = re.compile(r"overlaps .*?(?: and (\d+) more)? as drawn, by [\d.]+ mm: (contact between them is left out)?")
GRACE_S = 60  # of wall time after SIGTERM, before the process is killed
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def used_cpu_s(pid):
    """CPU seconds of a process and of those that it has waited for."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return sum(int(field) for field in fields[11:15]) / TICKS_PER_S


def run(command, cache, limit_s):
    """The answer (None where there is none), standard error, CPU seconds, peak MB, and whether it was ended."""
    environment = {key: value for key, value in os.environ.items() if key != "HVAS_CACHE"}
    environment["XDG_CACHE_HOME"] = cache
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = subprocess.Popen(command, stdout=out, stderr=err, env=environment)
        ended_at = None
        while (waited := os.wait4(process.pid, os.WNOHANG))[0] == 0:
            if ended_at is None and used_cpu_s(process.pid) > limit_s:
                process.send_signal(signal.SIGTERM)
                ended_at = time.monotonic()
            if ended_at is not None and time.monotonic() > ended_at + GRACE_S:
                process.send_signal(signal.SIGKILL)
            time.sleep(0.1)
        process.returncode, usage = waited[1:]
        out.seek(0)
        err.seek(0)
        text = out.read()
        answer = json.loads(text) if text.startswith(b"{") else None
        return answer, err.read().decode(errors="replace").strip(), usage.ru_utime + usage.ru_stime, \
            usage.ru_maxrss / 1024, ended_at is not None


def list_products(folder):
    """Files, and folders of meshes."""
    products = []
    for path in sorted(folder.rglob("*")):
        is_mesh_folder = path.is_dir() and sum(p.suffix.lower() in MESHES for p in path.iterdir()) > 1
        if is_mesh_folder or (path.is_file() and path.suffix.lower() in FILES):
            products.append(path)
    return products


def count_overlaps(parts):
    """Pairs of parts without contact, and pairs whose faces give way."""
    left_out, give_way = 0, 0
    for part in parts:
        for more, is_left_out in OVERLAP.findall(part["note"]):
            pairs = 1 + int(more or 0)
            left_out += pairs if is_left_out else 0
            give_way += 0 if is_left_out else pairs
    return (left_out + 1) // 2, (give_way + 1) // 2  # both parts of a pair have a note


def describe(name, seed, answer, import_s, cpu_s, memory, is_ended):
    parts = answer["parts"]
    left_out, give_way = count_overlaps(parts)
    run_s = answer.get("cpu_s", 0)
    return [name, str(seed), f"{answer['seated']}/{len(parts)}", "yes" if answer["seated"] == len(parts) else "no",
            str(answer["untouched"]), f"{left_out}, {give_way}",
            f"{max((part.get('beyond_drawn_um', 0) for part in parts), default=0) / 1000:.2f}", f"{import_s:.1f}, {max(0, cpu_s - run_s):.1f}, {run_s:.1f}",
            f"{answer['session_s']:.0f}", f"{memory:.0f}", "by the limit" if is_ended else ""]


def print_table(head, rows):
    for row in [head, ["-"] * len(head), *rows]:
        print("| " + " | ".join(row) + " |")
    print()


def compare_seeds(answers):
    """A row for each product with several seeds: the parts that some seeds do not bring to their places."""
    rows = []
    for name, by_seed in answers.items():
        if len(by_seed) < 2:
            continue
        seated = {seed: {part["name"] for part in answer["parts"] if part["seated"]} for seed, answer in by_seed.items()}
        common, any_of = set.intersection(*seated.values()), set.union(*seated.values())
        total = len(next(iter(by_seed.values()))["parts"])
        differing = [f"{part} (not with {', '.join(seed for seed in seated if part not in seated[seed])})"
                     for part in sorted(any_of - common)]
        rows.append([name, str(len(by_seed)), f"{len(common)} to {len(any_of)} of {total}", "; ".join(differing) or "none"])
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hvas")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seeds", default="1", help="separated by commas")
    parser.add_argument("--limit", type=float, default=300, help="processor time of one process [s]")
    parser.add_argument("--match", default="", help="only products whose path has one of these words, separated by commas")
    parser.add_argument("--parts", default="2-150", help="least and most parts of a product")
    parser.add_argument("--write", type=pathlib.Path)
    arguments = parser.parse_args()
    least, most = (int(number) for number in arguments.parts.split("-"))
    rows, causes, skipped, answers, is_good = [], [], [], {}, True
    for product in list_products(arguments.folder):
        name = str(product.relative_to(arguments.folder))
        if not any(word in name for word in arguments.match.split(",")):
            continue
        with tempfile.TemporaryDirectory() as cache:
            found, error, import_s, import_memory, _ = run(
                [arguments.hvas, "inspect", "--json", "-q", str(product)], cache, arguments.limit)
            count = found["summary"]["occurrences"] if found else 0
            if not least <= count <= most:
                skipped.append(f"{name}: {f'{count} parts' if found else error or 'no answer'}")
                continue
            for seed in arguments.seeds.split(","):
                answer, error, cpu_s, memory, is_ended = run(
                    [arguments.hvas, "assemble", str(product), "--json", "-q", "--reasons", "0", "--seed", seed], cache, arguments.limit)
                if answer is None:
                    is_good = False
                    reason = "no answer within the limit" if is_ended else error
                    rows.append([name, seed, f"0/{count}", "no", *[""] * 6, reason])
                else:
                    answers.setdefault(name, {})[seed] = answer
                    rows.append(describe(name, seed, answer, import_s, cpu_s, max(memory, import_memory), is_ended))
                    causes += [[name, seed, part["name"], part["reason"]] for part in answer["parts"] if not part["seated"]]
                print(" | ".join(rows[-1]), file=sys.stderr)
        if arguments.write:
            arguments.write.write_text(json.dumps({"rows": rows, "skipped": skipped, "answers": answers}, indent=1))
    print_table(HEAD, rows)
    if causes:
        print_table(["product", "seed", "part not in its place", "cause"], causes)
    if seeds := compare_seeds(answers):
        print_table(["product", "seeds", "parts in place", "differing"], seeds)
    for line in skipped:
        print(f"left out: {line}")
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
