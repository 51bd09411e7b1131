// What the compiler lets pass: promises that nobody waits for, cases that are forgotten, names that are not there.
import { fileURLToPath } from "node:url";
import eslint from "@eslint/js";
import { defineConfig, globalIgnores } from "eslint/config";
import globals from "globals";
import tseslint from "typescript-eslint";

const root = fileURLToPath(new URL(".", import.meta.url));

// `const { secret, ...rest } = all` is how an object is had without one of its members.
const unused = { ignoreRestSiblings: true };

export default defineConfig(
  globalIgnores(["dist/", "shots/"]),
  { linterOptions: { reportUnusedDisableDirectives: "error" } },
  eslint.configs.recommended,
  { rules: { eqeqeq: ["error", "always", { null: "ignore" }], "no-unused-vars": ["error", unused] } },
  {
    files: ["**/*.{ts,tsx}"],
    extends: [tseslint.configs.recommendedTypeChecked],
    languageOptions: { parserOptions: { projectService: true, tsconfigRootDir: root } },
    rules: {
      "@typescript-eslint/no-deprecated": "error",
      "@typescript-eslint/no-unused-vars": ["error", unused],
      "@typescript-eslint/prefer-readonly": "error",
      "@typescript-eslint/switch-exhaustiveness-check": ["error", { considerDefaultExhaustiveForUnions: true }],
    },
  },
  {
    files: ["test/**"],
    // What stands in for a server answers by a promise, though it has nothing to wait for.
    rules: { "@typescript-eslint/require-await": "off" },
  },
  {
    files: ["**/*.mjs"],
    // A test in a browser hands functions to the page, so that both worlds are in one file.
    languageOptions: { globals: { ...globals.nodeBuiltin, ...globals.browser } },
  },
  {
    files: ["e2e/**/*.mjs"],
    extends: [tseslint.configs.base],
    languageOptions: { parserOptions: { projectService: true, tsconfigRootDir: root } },
    rules: {
      // A step that is not waited for makes a test that fails now and then.
      "@typescript-eslint/await-thenable": "error",
      "@typescript-eslint/no-floating-promises": [
        "error",
        { allowForKnownSafeCalls: [{ from: "package", name: ["describe", "it", "before", "after"], package: "node:test" }] },
      ],
      "no-restricted-globals": ["error", "setTimeout", "setInterval"],
      "no-restricted-properties": [
        "error",
        { property: "waitForTimeout", message: "Wait for the condition that the time would stand for; see harness.mjs." },
      ],
    },
  },
);
