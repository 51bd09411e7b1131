// What the first load of the page weighs, compressed as the server sends it; fails above the limit.
//   npm run build && npm run size [-- FOLDER]

import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { brotliCompressSync } from "node:zlib";

const LIMIT = 300_000;
const folder = process.argv[2] ?? "dist";
/** Loaded only when somebody asks for what they show. */
const LATER = /^(vr_session|compare|devices_dialog|recordings_dialog)/;

const files = ["index.html", ...readdirSync(join(folder, "assets")).map((name) => join("assets", name))];
let total = 0;
for (const file of files) {
  const bytes = readFileSync(join(folder, file));
  const size = brotliCompressSync(bytes).length;
  const isLater = LATER.test(file.replace("assets/", ""));
  total += isLater ? 0 : size;
  console.log(`${String(size).padStart(8)}  of ${String(bytes.length).padStart(8)}  ${file}${isLater ? "  (later)" : ""}`);
}
console.log(`${String(total).padStart(8)}  first load, of at most ${LIMIT}`);
process.exit(total > LIMIT ? 1 : 0);
