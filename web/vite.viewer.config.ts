import { defineConfig } from "vite";
import studio from "./vite.config";

/** One script without imports, which pages of work instructions have in themselves. */
export default defineConfig({
  plugins: studio.plugins,
  build: {
    target: "es2022",
    outDir: process.env["HVAS_WEB_OUT"] ?? "dist",
    emptyOutDir: true,
    chunkSizeWarningLimit: 1200,
    lib: { entry: "src/instructions/viewer.ts", formats: ["iife"], name: "hvasViewer", fileName: () => "viewer.js" },
  },
});
