// Imports go downward only, protocol <- model <- view3d <- app and instructions, and never in a circle. Types count as well.

import { existsSync, readFileSync, readdirSync } from "node:fs";
import { dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../src", import.meta.url));
const LAYERS = ["protocol", "model", "view3d", "app", "instructions"];
/** Packages that only these layers may know. */
const PACKAGES = {
  preact: ["app"],
  "preact/hooks": ["app"],
  qr: ["app"],
  uplot: ["app"],
  "uplot/dist/uPlot.min.css": ["app"],
  three: ["view3d", "instructions"],
  "camera-controls": ["view3d"],
  "three-mesh-bvh": ["view3d"],
  "@preact/signals": ["model", "view3d", "app"],
};
const MOST_LINES = 320;

const faults = [];
/** For each module of the client, by its path from `root`: those that it imports. */
const imports = new Map();
for (const layer of LAYERS) {
  for (const name of readdirSync(join(root, layer), { recursive: true })) {
    if (/\.tsx?$/.test(name)) {
      check(layer, join(root, layer, name));
    }
  }
}
faults.push(...circles().map((circle) => `modules import each other: ${circle.join(" -> ")}`));

function check(layer, file) {
  const text = readFileSync(file, "utf8");
  const where = relative(root, file);
  if (text.split("\n").length > MOST_LINES && !text.startsWith("// Made from")) {
    faults.push(`${where}: more than ${MOST_LINES} lines`);
  }
  for (const [, target] of text.matchAll(/(?:from|import)\s*\(?\s*"([^"]+)"/g)) {
    if (target.startsWith(".")) {
      imports.set(where, [...(imports.get(where) ?? []), moduleAt(resolve(dirname(file), target))]);
    }
    const fault = target.startsWith(".") ? upward(layer, file, target) : foreign(layer, target);
    if (fault) {
      faults.push(`${where}: ${fault}`);
    }
  }
}

/** The module that an import of this path means, by its path from `root`. */
function moduleAt(path) {
  const ending = [".ts", ".tsx"].find((each) => existsSync(path + each)) ?? "";
  return relative(root, path + ending);
}

/** Of every group of modules that import each other, one circle. */
function circles() {
  const found = [];
  const isDone = new Set();
  const visit = (module, way) => {
    if (way.includes(module)) {
      found.push([...way.slice(way.indexOf(module)), module]);
      return;
    }
    if (isDone.has(module)) {
      return;
    }
    for (const next of imports.get(module) ?? []) {
      visit(next, [...way, module]);
    }
    isDone.add(module);
  };
  for (const module of imports.keys()) {
    visit(module, []);
  }
  return found;
}

function upward(layer, file, target) {
  const to = relative(root, resolve(dirname(file), target)).split("/")[0];
  return LAYERS.indexOf(to) > LAYERS.indexOf(layer) ? `${layer} may not know ${to}` : null;
}

function foreign(layer, target) {
  const key = target.startsWith("three/") ? "three" : target;
  return PACKAGES[key]?.includes(layer) ? null : `${layer} may not know ${target}`;
}

if (faults.length > 0) {
  console.error(faults.join("\n"));
  process.exit(1);
}
