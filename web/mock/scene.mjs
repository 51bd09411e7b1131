// A scene for the mock server, made of what `hvas export` and `hvas inspect` say of a file.

import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

const NO_TURN = [1, 0, 0, 0];
const mm = (v) => v.map((x) => x / 1e3);
const hex = (rgb) => "#" + rgb.map((c) => Math.round(255 * c).toString(16).padStart(2, "0")).join("");

function runTool(hvas, file) {
  const folder = mkdtempSync(join(tmpdir(), "hvas-mock-"));
  const glbPath = join(folder, "product.glb");
  execFileSync(hvas, ["export", file, "-o", glbPath, "-q"]);
  const options = { maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"] };
  return {
    glb: readFileSync(glbPath),
    product: JSON.parse(execFileSync(hvas, ["inspect", file, "--json"], options)),
    run: JSON.parse(execFileSync(hvas, ["assemble", file, "--json"], options)),
  };
}

function boxOf(part, position) {
  return { low: mm(part.box_low_mm).map((v, k) => v + position[k]), high: mm(part.box_high_mm).map((v, k) => v + position[k]) };
}

/** Loose parts in rows on the table, around the base. */
function layOut(occurrences, parts, radius, tableZ) {
  let x = -1.5 * radius;
  let y = -1.25 * radius;
  let row = 0;
  for (const o of occurrences.filter((each) => !each.is_base)) {
    const part = parts[o.part];
    const size = mm(part.box_high_mm).map((v, k) => v - part.box_low_mm[k] / 1e3);
    if (x + size[0] > 1.5 * radius) {
      x = -1.5 * radius;
      y -= row + 0.008;
      row = 0;
    }
    o.start = { p: [x - part.box_low_mm[0] / 1e3, y - part.box_high_mm[1] / 1e3, tableZ - part.box_low_mm[2] / 1e3], q: NO_TURN };
    x += size[0] + 0.008;
    row = Math.max(row, size[1]);
  }
}

function makeMate(m, occurrences, features) {
  const hole = m.hole;
  const goal = occurrences[hole?.occurrence ?? 0].goal.p;
  const feature = features.find((f) => hole && f.part === occurrences[hole.occurrence].part && f.id === hole.feature);
  return {
    id: m.id,
    key: m.key,
    kind: m.kind,
    a: m.hole?.occurrence ?? m.a?.occurrence ?? 0,
    b: m.shaft?.occurrence ?? m.b?.occurrence ?? 0,
    faces_a: m.surfaces?.map((s) => s.a) ?? [],
    faces_b: m.surfaces?.map((s) => s.b) ?? [],
    origin: m.origin,
    p_m: feature ? mm(feature.origin_mm).map((v, k) => v + goal[k]) : goal,
    axis: feature?.axis ?? [0, 0, 1],
    confidence: m.confidence,
    evidence: m.evidence,
    fit: m.fit
      ? {
          code: m.fit.code,
          kind: m.fit.kind,
          diameter_mm: m.fit.nominal_diameter_mm,
          clearance_min_um: m.fit.kind === "interference" ? -35 : 9,
          clearance_max_um: m.fit.kind === "interference" ? -1 : 50,
          clearance_actual_um: m.fit.kind === "interference" ? -18 : 31,
          clearance_along_um: m.fit.kind === "interference" ? [-23.4, -12.1] : [25.2, 36.9],
          is_proposed: m.fit.is_proposed,
          reason: m.fit.reason,
        }
      : null,
  };
}

export function makeScene(hvas, file, epoch) {
  const { glb, product, run } = runTool(hvas, file);
  const occurrences = product.occurrences.map((o) => {
    const part = product.parts[o.part];
    const goal = { p: mm(o.position_mm), q: o.rotation_wxyz };
    return {
      id: o.id,
      name: o.name,
      path: o.path,
      parent: o.subassembly,
      part: o.part,
      color: hex(part.color_srgb ?? [0.6, 0.62, 0.66]),
      placement: o.id === run.parts[0].id ? "placed" : "loose",
      start: goal,
      goal,
      mass_kg: part.mass_kg,
      material: part.material.name,
      p_BoBcm_m: mm(part.centre_of_mass_mm),
      is_base: o.id === run.parts[0].id,
    };
  });
  const boxes = occurrences.map((o) => boxOf(product.parts[o.part], o.goal.p));
  const low = [0, 1, 2].map((k) => Math.min(...boxes.map((b) => b.low[k])));
  const high = [0, 1, 2].map((k) => Math.max(...boxes.map((b) => b.high[k])));
  const radius = Math.hypot(...high.map((v, k) => v - low[k])) / 2;
  layOut(occurrences, product.parts, radius, low[2]);
  const hash = createHash("sha256").update(glb).digest("hex").slice(0, 32);
  const scene = {
    epoch,
    name: product.summary.name,
    source: basename(file),
    glb: `/api/model/${hash}.glb`,
    triangles: product.occurrences.reduce((n, o) => n + product.parts[o.part].display_triangle_count, 0),
    table_z_m: low[2],
    centre_m: low.map((v, k) => (v + high[k]) / 2),
    radius_m: radius,
    seed: String(run.seed),
    next_step: 1,
    pending: 0,
    subassemblies: product.subassemblies,
    occurrences,
    mates: product.mates.map((m) => makeMate(m, occurrences, product.features)),
    left_out: [],
    steps: run.parts.map((p, k) => ({
      kind: k === 0 ? "base" : "insert",
      occurrence: p.id,
      members: [],
      way_in: [0, 0, -1],
      distance_m: 0.6 * radius,
    })),
    diagnostics: [],
  };
  return { scene, glb };
}
