// What `npm ci` asks of the lock file: an entry for every package that another one names, those for other systems included. No download addresses.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, it } from "vitest";

interface Entry { version?: string; resolved?: string; integrity?: string; dependencies?: Record<string, string>; optionalDependencies?: Record<string, string> }
const lock = JSON.parse(readFileSync(join(__dirname, "../../src/viewer/package-lock.json"), "utf8")) as { packages: Record<string, Entry> };

it("has every package that another one names, optional ones too", () => {
  const missing: string[] = [];
  for (const [path, entry] of Object.entries(lock.packages)) {
    for (const name of Object.keys({ ...entry.dependencies, ...entry.optionalDependencies })) {
      const parts = path === "" ? [] : path.split("/node_modules/");
      const places = parts.map((_, n) => `${parts.slice(0, n + 1).join("/node_modules/")}/node_modules/${name}`).concat(`node_modules/${name}`);
      if (!places.some((place) => place in lock.packages)) missing.push(`${name} (of ${path})`);
    }
  }
  expect(missing).toEqual([]);
});

it("pins each by its content and names no address", () => {
  for (const [path, entry] of Object.entries(lock.packages)) {
    if (path === "") continue;
    expect(entry.integrity, path).toMatch(/^sha512-/);
    expect(entry.resolved, path).toBeUndefined();
  }
});
