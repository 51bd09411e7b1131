// Puts the files of a folder into a program: embed_assets.mjs DIST OUT writes OUT/assets.cc, which
// includes them plain, by gzip and by brotli, as src/studio/assets.h wants them.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { join, relative, resolve } from "node:path";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";

const kTypes = {
  html: "text/html; charset=utf-8",
  js: "text/javascript; charset=utf-8",
  css: "text/css; charset=utf-8",
  svg: "image/svg+xml",
  png: "image/png",
  json: "application/json",
  wasm: "application/wasm",
  webmanifest: "application/manifest+json",
};

function listFiles(folder) {
  return readdirSync(folder)
    .sort()
    .flatMap((name) => {
      const path = join(folder, name);
      return statSync(path).isDirectory() ? listFiles(path) : [path];
    });
}

/** The same bytes another way, or nothing where that saves little. */
function smaller(bytes, packed) {
  return packed.length < 0.9 * bytes.length ? packed : undefined;
}

function brotli(bytes) {
  return brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11 } });
}

const [dist, out] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(join(out, "packed"), { recursive: true });
const assembly = [];
const symbols = [];
const rows = [];

function include(symbol, path) {
  assembly.push(`.global ${symbol}`, `${symbol}:`, `.incbin "${path}"`, `.global ${symbol}_end`, `${symbol}_end:`);
  symbols.push(symbol);
  return `{${symbol}, static_cast<std::size_t>(${symbol}_end - ${symbol})}`;
}

listFiles(dist).forEach((path, i) => {
  const bytes = readFileSync(path);
  const name = `/${relative(dist, path)}`;
  const type = kTypes[path.split(".").pop()];
  if (type === undefined) {
    throw new Error(`${path}: no content type is known for this file`);
  }
  const ways = ["gzip", "brotli"].map((way) => {
    const packed = smaller(bytes, way === "gzip" ? gzipSync(bytes, { level: 9 }) : brotli(bytes));
    if (packed === undefined) {
      return "{}";
    }
    const file = join(out, "packed", `${i}.${way}`);
    writeFileSync(file, packed);
    return include(`hvas_asset_${i}_${way}`, file);
  });
  const etag = createHash("sha256").update(bytes).digest("hex").slice(0, 32);
  const immutable = name.startsWith("/assets/");
  rows.push(`    {"${name}", "${type}", "${etag}", ${include(`hvas_asset_${i}`, path)}, ${ways.join(", ")}, ${immutable}},`);
});

const declarations = symbols.map((s) => `extern const char ${s}[], ${s}_end[];`).join("\n");
writeFileSync(
  join(out, "assets.cc"),
  `// Made by tools/embed_assets.mjs.
#include "studio/assets.h"

#include <algorithm>
#include <array>
#include <cstddef>

asm(R"(
.pushsection .rodata
${assembly.join("\n")}
.popsection
)");

extern "C" {
${declarations}
}

namespace hvas::studio {

const Asset* FindAsset(std::string_view path) {
  static const std::array<Asset, ${rows.length}> assets{{
${rows.join("\n")}
  }};
  const auto found = std::find_if(assets.begin(), assets.end(), [&](const Asset& asset) { return asset.path == path; });
  return found != assets.end() ? &*found : nullptr;
}

}  // namespace hvas::studio
`,
);
