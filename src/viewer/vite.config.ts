import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";

const repository = fileURLToPath(new URL("../..", import.meta.url));

export default defineConfig({
  base: "./",
  build: { target: "es2021", chunkSizeWarningLimit: 900 },
  server: { fs: { allow: [repository] } },
  resolve: { alias: { "@viewer": `${repository}/src/viewer/src` }, dedupe: ["three", "uplot"] },
  test: {
    globals: true,
    environment: "happy-dom",
    dir: `${repository}/tests/viewer`,
    include: ["**/*.test.ts"],
  },
});
