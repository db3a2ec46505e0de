// Browser tests: Debian's Chromium, driven by playwright-core, on the built viewer and (where FILUM_BIN names it) the real trainer.
import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";

const repository = fileURLToPath(new URL("../..", import.meta.url));

export default defineConfig({
  resolve: { alias: { "@viewer": `${repository}/src/viewer/src`, "playwright-core": `${repository}/src/viewer/node_modules/playwright-core/index.mjs` } },
  test: {
    globals: true,
    environment: "node",
    dir: `${repository}/tests/browser`,
    include: ["**/*.test.ts"],
    fileParallelism: false,
    testTimeout: 300_000, // a software-rendered page on a busy machine; tests wait for states, not for times
    hookTimeout: 120_000,
  },
});
