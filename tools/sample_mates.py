#!/usr/bin/env python3
"""Mates of strangers' files for a person to judge: precision and recall of the inference.

  tools/sample_mates.py sample HVAS FOLDER [--mates 200] [--missed 60] [--seed 1] > list.tsv
  tools/sample_mates.py score list.tsv

`sample` opens every product of a folder with `hvas inspect --json --all` and writes one row for each sampled mate
("mate") and for each sampled pair of features that lie nearly as a mate does and are none ("missed?"), with what a
judge needs: parts, sizes, distances, engaged length or area, confidence, fit, and for a pair that was not mated the
limit that it misses. Equal mates of equal parts are one row with their count. Rows are drawn from the strata (kind of
mate, kind of fit) in turn, and within a stratum from the files in turn, with a seeded generator.

The judge fills the column `verdict`: "right", "wrong" (no engineer would mate these), "fit" (the mate is right, its fit
is not), "missed" or "none" (rightly not mated), and the column `why`. `score` prints precision and recall, by rows and
by counts, with Wilson's interval of 95 %.
"""

import argparse
import collections
import csv
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys

EXTENSIONS = {".step", ".stp"}
COLUMNS = ["row", "verdict", "why", "count", "stratum", "file", "id", "part_a", "part_b", "details", "confidence", "fit"]
# How much wider than the limits of docs/algorithms/mates.md candidates for missed mates are looked for: choices.
WIDE_ANGLE_DEG, WIDE_AXIS_MM, WIDE_RADIUS_MM, WIDE_RADIUS_RATIO, WIDE_GAP_MM = 0.5, 0.25, 1.0, 0.5, 0.3
ANGLE_DEG, AXIS_MM, COVERAGE_DEG, ENGAGED_MM, GAP_MM = 0.1, 0.02, 200, 0.05, 0.01


def rotate(q, v):
    w, x, y, z = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add(a, b, scale=1.0):
    return [x + scale * y for x, y in zip(a, b)]


def norm(a):
    return math.sqrt(dot(a, a))


class Product:
    """The answer of `hvas inspect --json --all`, with features placed in the world."""

    def __init__(self, file, answer):
        self.file, self.answer = file, answer
        self.parts = {part["id"]: part for part in answer["parts"]}
        self.occurrences = {item["id"]: item for item in answer["occurrences"]}
        self.features = collections.defaultdict(dict)
        for feature in answer["features"]:
            self.features[feature["part"]][feature["id"]] = feature
        self.placed = {}

    def name(self, occurrence):
        item = self.occurrences[occurrence]
        part = self.parts[item["part"]]["name"]
        return item["name"] if part == item["name"] else f"{item['name']} [{part}]"

    def feature(self, side):
        return self.features[self.occurrences[side["occurrence"]]["part"]][side["feature"]]

    def place(self, occurrence):
        """[(feature, origin, axis)] in the world [mm]."""
        if occurrence not in self.placed:
            item = self.occurrences[occurrence]
            q, p = item["rotation_wxyz"], item["position_mm"]
            self.placed[occurrence] = [
                (feature, add(rotate(q, feature["origin_mm"]), p), rotate(q, feature["axis"]))
                for feature in self.features[item["part"]].values()]
        return self.placed[occurrence]

    def box(self, occurrence):
        item = self.occurrences[occurrence]
        part = self.parts[item["part"]]
        corners = [add(rotate(item["rotation_wxyz"], corner), item["position_mm"])
                   for corner in itertools.product(*zip(part["box_low_mm"], part["box_high_mm"]))]
        return [min(c[k] for c in corners) for k in range(3)], [max(c[k] for c in corners) for k in range(3)]

    def scale(self, a, b):
        """As CalcLengthScale() of src/mates/limits.h."""
        size = min(norm(add(self.parts[self.occurrences[i]["part"]]["box_high_mm"],
                            self.parts[self.occurrences[i]["part"]]["box_low_mm"], -1)) for i in (a, b))
        return size / 5 if size < 5 else max(1.0, size / 1000)


def open_product(hvas, file):
    process = subprocess.run([hvas, "inspect", "--json", "--all", "-q", str(file)], capture_output=True, text=True)
    if process.returncode != 0:
        print(f"{file}: {process.stderr.strip()}", file=sys.stderr)
        return None
    return json.loads(process.stdout)


def list_mates(product):
    for mate in product.answer["mates"]:
        a, b = (mate["hole"], mate["shaft"]) if "hole" in mate else (mate["a"], mate["b"])
        fit = mate.get("fit")
        stratum = mate["kind"] + (" " + fit["kind"] if fit else "")
        stratum += " between walls" if mate["evidence"].startswith("between walls") else ""
        details = mate["evidence"]
        if mate["kind"] == "axis_hole":
            hole, shaft = product.feature(a), product.feature(b)
            details += (f"; hole {hole['span_high_mm'] - hole['span_low_mm']:.2f} mm long, turn {hole['coverage_deg']:.0f}"
                        f" deg; shaft {shaft['span_high_mm'] - shaft['span_low_mm']:.2f} mm, {shaft['coverage_deg']:.0f} deg")
        yield {"stratum": stratum, "file": product.file, "id": f"m{mate['id']}",
               "part_a": product.name(a["occurrence"]), "part_b": product.name(b["occurrence"]), "details": details,
               "confidence": f"{mate['confidence']:.2f}",
               "fit": f"{fit['kind']} {fit['code']} ({fit['reason']})" if fit else "",
               "equal": (product.occurrences[a["occurrence"]]["part"], product.occurrences[b["occurrence"]]["part"],
                         a["feature"], b["feature"], mate["evidence"].split(", axes")[0])}


def measure_axes(first, second):
    """(angle deg, distance mm, common span mm along the first) of two placed features."""
    (f, p, u), (g, q, w) = first, second
    turn = dot(u, w)
    angle = math.degrees(math.acos(min(1.0, abs(turn))))
    shift = dot(add(q, p, -1), u)
    ends = sorted([shift + turn * g["span_low_mm"], shift + turn * g["span_high_mm"]])
    low, high = max(f["span_low_mm"], ends[0]), min(f["span_high_mm"], ends[1])
    middle = add(p, u, 0.5 * (low + high))
    d = add(middle, q, -1)
    return angle, norm(add(d, w, -dot(d, w))), high - low


def explain_axis(product, a, b, hole, shaft, measured):
    """Which limit of mates.md, section 1, a pair of hole and shaft misses; else a rule of section 2."""
    angle, distance, span = measured
    scale = product.scale(a, b)
    smaller = min(hole["radius_mm"], shaft["radius_mm"])
    reasons = []
    if angle > ANGLE_DEG:
        reasons.append(f"axes {angle:.2f} deg off")
    if distance > AXIS_MM * scale:
        reasons.append(f"axes {1000 * distance:.0f} um apart")
    if abs(hole["radius_mm"] - shaft["radius_mm"]) > max(min(0.6 * scale, 0.5 * smaller), 0.3 * smaller):
        reasons.append("radii differ")
    if span < ENGAGED_MM * scale:
        reasons.append("hardly engaged")
    reasons += [f"{name} turns {side['coverage_deg']:.0f} deg" for name, side in (("hole", hole), ("shaft", shaft))
                if side["coverage_deg"] < COVERAGE_DEG and len(side["faces"]) < 2]
    return ", ".join(reasons) or "a rule (part between, guided elsewhere, tube around)"


def list_missed(product):
    """Pairs of features beside the limits. A pair of parts that is mated on an axis or plane already has none there."""
    known = collections.defaultdict(list)
    for mate in product.answer["mates"]:
        a, b = (mate["hole"], mate["shaft"]) if "hole" in mate else (mate["a"], mate["b"])
        item = product.occurrences[a["occurrence"]]
        feature = product.feature(a)
        features = [feature]
        if "opposite" in a:  # The other wall of a prismatic mate.
            features.append(product.features[item["part"]][a["opposite"]])
        known[frozenset((a["occurrence"], b["occurrence"]))] += [
            (mate["kind"], add(rotate(item["rotation_wxyz"], each["origin_mm"]), item["position_mm"]),
             rotate(item["rotation_wxyz"], each["axis"])) for each in features]
    boxes = {occurrence: product.box(occurrence) for occurrence in product.occurrences}
    for a, b in itertools.combinations(sorted(product.occurrences), 2):
        if any(boxes[a][0][k] - WIDE_GAP_MM > boxes[b][1][k] or boxes[b][0][k] - WIDE_GAP_MM > boxes[a][1][k]
               for k in range(3)):
            continue
        best = {}
        for one, other in itertools.product(product.place(a), product.place(b)):
            found = compare(product, a, b, one, other, known[frozenset((a, b))])
            if found:
                kind, size, details, reason = found
                key = (kind, tuple(round(abs(x), 2) for x in one[2]))
                if key not in best or size > best[key][0]:
                    best[key] = (size, details, reason)
        for (kind, _), (_, details, reason) in best.items():
            yield {"stratum": f"missed? {kind}", "file": product.file, "id": "", "part_a": product.name(a),
                   "part_b": product.name(b), "details": f"{details}; {reason}", "confidence": "", "fit": "",
                   "equal": (product.occurrences[a]["part"], product.occurrences[b]["part"], kind, details)}


def compare(product, a, b, one, other, known):
    f, g = one[0], other[0]
    kinds = {f["kind"], g["kind"]}
    if kinds == {"hole", "shaft"}:
        hole, shaft = (one, other) if f["kind"] == "hole" else (other, one)
        r, s = hole[0]["radius_mm"], shaft[0]["radius_mm"]
        if abs(r - s) > max(WIDE_RADIUS_MM, WIDE_RADIUS_RATIO * min(r, s)):
            return None
        angle, distance, span = measure_axes(hole, shaft)
        if angle > WIDE_ANGLE_DEG or distance > WIDE_AXIS_MM or span <= 0:
            return None
        for kind, p, u in known:
            d = add(p, hole[1], -1)
            if kind != "face_face" and abs(dot(u, hole[2])) > 0.999 and norm(add(d, u, -dot(d, u))) < WIDE_AXIS_MM:
                return None
        details = (f"diameters {2 * r:.3f}/{2 * s:.3f} mm, engaged {span:.2f} mm, axes {1000 * distance:.1f} um apart, "
                   f"turns {hole[0]['coverage_deg']:.0f}/{shaft[0]['coverage_deg']:.0f} deg")
        return "axis", span, details, explain_axis(product, a, b, hole[0], shaft[0], (angle, distance, span))
    if kinds == {"plane"} and dot(one[2], other[2]) < -math.cos(math.radians(WIDE_ANGLE_DEG)):
        between = add(other[1], one[1], -1)
        gap = dot(one[2], between)
        if abs(gap) > WIDE_GAP_MM:
            return None
        # A face is taken for a disc of its area: the lists have no outlines.
        reach = [math.sqrt(side["area_mm2"] / math.pi) for side in (f, g)]
        across = norm(add(between, one[2], -gap))
        if across > 0.7 * max(reach) + 0.3 * min(reach):
            return None
        for kind, p, u in known:
            if kind in ("face_face", "prismatic") and abs(dot(u, one[2])) > 0.999 and abs(dot(u, add(p, one[1], -1))) < WIDE_GAP_MM:
                return None
        angle = math.degrees(math.acos(min(1.0, -dot(one[2], other[2]))))
        reason = f"normals {angle:.2f} deg off" if angle > ANGLE_DEG else (
            "a gap without walls" if gap > GAP_MM else "drawn into each other" if gap < -GAP_MM else "little overlap")
        return "plane", min(f["area_mm2"], g["area_mm2"]), \
            f"areas {f['area_mm2']:.1f}/{g['area_mm2']:.1f} mm2, gap {gap:.3f} mm, centres {across:.2f} mm apart", reason
    return None


def draw(rows, count, generator):
    """Equal rows become one with their count; then the strata, and in them the files, give one row after the other."""
    merged = {}
    for row in rows:
        key = (row["file"], row["stratum"], row["equal"])
        merged.setdefault(key, dict(row, count=0))["count"] += 1
    strata = collections.defaultdict(lambda: collections.defaultdict(list))
    for row in merged.values():
        strata[row["stratum"]][row["file"]].append(row)
    queues = []
    for stratum in sorted(strata):
        files = sorted(strata[stratum])
        generator.shuffle(files)
        for file in files:
            generator.shuffle(strata[stratum][file])
        queues.append([row for turn in itertools.zip_longest(*(strata[stratum][file] for file in files)) for row in turn if row])
    drawn = [row for turn in itertools.zip_longest(*queues) for row in turn if row][:count]
    return sorted(drawn, key=lambda row: (row["stratum"], row["file"], row["id"]))


def sample(arguments):
    generator = random.Random(arguments.seed)
    mates, missed = [], []
    for file in sorted(path for path in arguments.folder.rglob("*") if path.suffix.lower() in EXTENSIONS):
        answer = open_product(arguments.hvas, file)
        if answer and len(answer["occurrences"]) > 1:
            product = Product(str(file.relative_to(arguments.folder)), answer)
            mates += list_mates(product)
            if len(answer["occurrences"]) <= arguments.most_parts:
                missed += list_missed(product)
    writer = csv.DictWriter(sys.stdout, COLUMNS, delimiter="\t", extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    rows = draw(mates, arguments.mates, generator) + draw(missed, arguments.missed, generator)
    for number, row in enumerate(rows, 1):
        writer.writerow(dict(row, row=number, verdict="", why=""))
    counts = collections.Counter(row["stratum"] for row in mates + missed)
    for stratum, count in sorted(counts.items()):
        print(f"{count:6d} {stratum}", file=sys.stderr)


def wilson(right, all_of):
    """Wilson's interval of 95 % (Journal of the American Statistical Association 22, 1927)."""
    if all_of == 0:
        return 0.0, 1.0
    z, p = 1.959964, right / all_of
    middle, half = p + z * z / (2 * all_of), z * math.sqrt(p * (1 - p) / all_of + z * z / (4 * all_of * all_of))
    return (middle - half) / (1 + z * z / all_of), (middle + half) / (1 + z * z / all_of)


def score(arguments):
    with open(arguments.list, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    by_stratum = collections.defaultdict(list)
    for row in rows:
        by_stratum[row["stratum"]].append(row)
    print("stratum | rows | right | wrong | fit | missed | none\n---|---|---|---|---|---|---")
    for stratum, members in sorted(by_stratum.items()):
        verdicts = collections.Counter(row["verdict"] for row in members)
        print(" | ".join([stratum, str(len(members))] + [str(verdicts[v]) for v in ("right", "wrong", "fit", "missed", "none")]))
    for label, weigh in (("rows", lambda row: 1), ("mates", lambda row: int(row["count"]))):
        total = collections.Counter()
        for row in rows:
            total[row["verdict"]] += weigh(row)
        right = total["right"] + total["fit"]
        for name, part, whole in (("precision", right, right + total["wrong"]), ("precision with fits", total["right"],
                                                                                 right + total["wrong"]),
                                  ("recall", right, right + total["missed"])):
            low, high = wilson(part, whole)
            print(f"{name} by {label}: {part}/{whole} = {part / max(whole, 1):.3f} ({low:.3f} to {high:.3f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    draws = commands.add_parser("sample")
    draws.add_argument("hvas")
    draws.add_argument("folder", type=pathlib.Path)
    draws.add_argument("--mates", type=int, default=200)
    draws.add_argument("--missed", type=int, default=60)
    draws.add_argument("--most-parts", type=int, default=150, help="larger products are not searched for missed mates")
    draws.add_argument("--seed", type=int, default=1)
    draws.set_defaults(run=sample)
    scores = commands.add_parser("score")
    scores.add_argument("list")
    scores.set_defaults(run=score)
    arguments = parser.parse_args()
    arguments.run(arguments)


if __name__ == "__main__":
    main()
