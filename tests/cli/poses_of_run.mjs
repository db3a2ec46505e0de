// Writes a demonstration that moves every tool as a recorded run did: absolute poses, nothing looked up in the scene, as a hand on a wire sends them.
// Usage: node poses_of_run.mjs samples.csv >script.yaml (samples.csv of `filum export --format csv`)
import { readFileSync } from "node:fs";

const every = 20; // samples between keys: 20 ms of a script's 1 kHz

const [head, ...lines] = readFileSync(process.argv[2], "utf8").trim().split("\n");
const names = head.split(",");
const tools = new Map();
for (const line of lines) {
  const sample = Object.fromEntries(line.split(",").map((text, k) => [names[k], Number(text)]));
  if (!tools.has(sample.tool)) tools.set(sample.tool, []);
  tools.get(sample.tool).push(sample);
}

const list = (values, digits, unit = "") => `[${values.map((v) => (unit ? `"${v.toFixed(digits)} ${unit}"` : v.toFixed(digits))).join(", ")}]`;
// Third and first column of the rotation: towards the handle, and across the jaws.
const handle = ({ q_w: w, q_x: x, q_y: y, q_z: z }) => [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
const opening = ({ q_w: w, q_x: x, q_y: y, q_z: z }) => [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)];

const out = ["format: filum-demonstration/1", "title: The poses of a run", "tools:"];
for (const [tool, samples] of [...tools].sort(([a], [b]) => a - b)) {
  out.push(`  - tool: ${tool}`, "    keys:");
  samples
    .filter((_, k) => k % every === 0)
    .forEach((s) => {
      const p = list([s.p_x, s.p_y, s.p_z].map((v) => 1e3 * v), 5, "mm");
      const degrees = ((180 / Math.PI) * s.grip_angle).toFixed(4);
      out.push(`      - { t: "${(1e-6 * s.device_time).toFixed(4)} s", p: ${p}, handle: ${list(handle(s), 6)}, opening: ${list(opening(s), 6)}, grip: "${degrees} deg" }`);
    });
}
console.log(out.join("\n"));
