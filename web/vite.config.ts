import { readFileSync } from "node:fs";
import { defineConfig } from "vitest/config";
import type { Plugin } from "vite";

/** Bundles no package whose licence THIRD-PARTY.md does not have. */
function licensed(): Plugin {
  const listed = readFileSync(new URL("../THIRD-PARTY.md", import.meta.url), "utf8");
  return {
    name: "licensed",
    generateBundle(_options, bundle) {
      for (const chunk of Object.values(bundle)) {
        for (const id of chunk.type === "chunk" ? Object.keys(chunk.modules) : []) {
          const name = /^.*node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(id)?.[1];
          if (name !== undefined && !listed.includes(`\n### ${name} `)) {
            this.error(`${name} is bundled and has no entry in THIRD-PARTY.md: run tools/third_party.py`);
          }
        }
      }
    },
  };
}

export default defineConfig({
  base: "/",
  build: {
    target: "es2022",
    outDir: process.env["HVAS_WEB_OUT"] ?? "dist",
    emptyOutDir: true,
    // The policy of the server allows no data: scripts or fonts, so nothing is inlined.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
  },
  plugins: [licensed()],
  worker: { format: "es", plugins: () => [licensed()] },
  test: { include: ["test/**/*.test.ts"], environment: "node" },
});
