// What the first load of the page weighs, compressed as the server sends it; fails above the limit.
//   npm run build && npm run size [-- FOLDER]

import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { brotliCompressSync } from "node:zlib";

const LIMIT = 300_000;
const folder = process.argv[2] ?? "dist";

/** What a file asks for at once. What is behind import() comes later, when somebody wants it. */
function asksFor(file) {
  const text = readFileSync(join(folder, file), "utf8");
  const static_ = [...text.matchAll(/(?:from|import|src=|href=)\s*"(?:\.\/|\/assets\/)([\w.-]+)"/g)];
  const workers = [...text.matchAll(/new URL\("\/assets\/([\w.-]+)"/g)];
  return [...static_, ...workers].map(([, name]) => join("assets", name));
}

const first = new Set();
const queue = ["index.html"];
while (queue.length > 0) {
  const file = queue.pop();
  if (!first.has(file)) {
    first.add(file);
    queue.push(...asksFor(file));
  }
}
let total = 0;
for (const file of ["index.html", ...readdirSync(join(folder, "assets")).map((name) => join("assets", name))]) {
  const bytes = readFileSync(join(folder, file));
  const size = brotliCompressSync(bytes).length;
  total += first.has(file) ? size : 0;
  console.log(`${String(size).padStart(8)}  of ${String(bytes.length).padStart(8)}  ${file}${first.has(file) ? "" : "  (later)"}`);
}
console.log(`${String(total).padStart(8)}  first load, of at most ${LIMIT}`);
process.exit(total > LIMIT ? 1 : 0);
