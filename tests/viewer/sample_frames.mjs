// Made-up messages of the trainer for tests of the viewer alone: a thread round the post, two instruments that move.

export const kTasks = [
  { name: "knot-square", title: "Square knot", summary: "Tie a square knot round the post by instrument tie and cut both tails.", chapter: "Knots", demonstration: false, shown: true, rated: true, dial: false, picture: "knot-square" },
  { name: "knot-surgeons", title: "Surgeon's knot", summary: "A double throw, then a single throw the other way.", chapter: "Knots", demonstration: false, shown: true, rated: false, dial: false, picture: "knot-surgeons" },
  { name: "knot-granny", title: "Granny knot", summary: "How a granny knot comes about, and why it slips.", chapter: "Knots", demonstration: true, shown: true, rated: false, dial: false, picture: "knot-granny" },
];
const kSteps = ["grasp the long end", "form the loop", "pass the short end", "lay the throw", "tighten", "second loop", "pass again", "tighten the knot", "cut the tails"];

export const kScene = {
  type: "scene", task: "knot-square", title: "Square knot", suture: "10-0-nylon", thread_radius: 12.5e-6, thread_strength: 0.15, dt: 0.002,
  post: { position: [0, 0, 0.44e-3], axis: [0, 1, 0], radius: 0.4e-3, half_length: 6e-3 }, base: { position: [0, 0, -0.44e-3], axis: [0, 1, 0], radius: 0.4e-3, half_length: 6e-3 },
  floor_height: -3e-3, capacity: 240,
  tools: [
    { name: "forceps-left", kind: "forceps", jaw_length: 12e-3, tip_radius: 0.15e-3, base_radius: 0.7e-3, pad_length: 2e-3, max_angle: 0.244 },
    { name: "needle-holder", kind: "needle-holder", jaw_length: 10e-3, tip_radius: 0.2e-3, base_radius: 0.8e-3, pad_length: 2.5e-3, max_angle: 0.314 },
    { name: "scissors", kind: "scissors", jaw_length: 10e-3, tip_radius: 0.15e-3, base_radius: 0.7e-3, pad_length: 4e-3, max_angle: 0.314 },
  ],
};

const mm = 1e-3;
/// Quaternion of a tool frame: z towards the handle, x along the part of `opening` across it.
function looking(handle, opening) {
  const unit = (v) => v.map((x) => x / Math.hypot(...v)), dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
  const z = unit(handle), along = dot(opening, z), x = unit(opening.map((v, k) => v - along * z[k]));
  const y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]];
  const w = 0.5 * Math.sqrt(Math.max(1e-12, 1 + x[0] + y[1] + z[2]));
  return w > 1e-3 ? [w, (y[2] - z[1]) / (4 * w), (z[0] - x[2]) / (4 * w), (x[1] - y[0]) / (4 * w)] : [0, 1, 0, 0];
}

/// Thread from the left tip, once round the post with one half knot above it, to the right tip.
function threadPoints(left, right, count) {
  const key = [left];
  const top = [0, 0, 0.96];
  for (let k = 0; k <= 6; ++k) { const s = k / 6; key.push([left[0] * (1 - s) - 1.1 * s, left[1] * (1 - s) + 0.3 * s, left[2] * (1 - s) + (top[2] + 0.5) * s + Math.sin(s * 3) * 0.5]); }
  for (let k = 0; k <= 40; ++k) { // three half twists above the post, then round it
    const s = k / 40, a = Math.PI * 3 * s;
    key.push([-0.55 + 1.1 * s, 0.16 * Math.cos(a), top[2] + 0.02 + 0.16 * Math.sin(a)]);
  }
  for (let k = 1; k < 24; ++k) { const a = Math.PI / 2 - (2 * Math.PI * k) / 24; key.push([0.43 * Math.cos(a), 0.1 - 0.2 * k / 24, 0.44 + 0.43 * Math.sin(a)]); }
  for (let k = 0; k <= 40; ++k) {
    const s = k / 40, a = Math.PI * 3 * s + Math.PI;
    key.push([-0.55 + 1.1 * s, 0.16 * Math.cos(a), top[2] + 0.02 + 0.16 * Math.sin(a)]);
  }
  for (let k = 0; k <= 10; ++k) { const s = k / 10; key.push([1.1 * (1 - s) + right[0] * s, -0.3 * (1 - s) + right[1] * s, (top[2] + 0.5) * (1 - s) + right[2] * s + Math.sin(s * 3) * 1.4]); }
  for (let k = 1; k <= 26; ++k) { const s = k / 26; key.push([right[0] + 7 * Math.sin(2.4 * s) * s - 2 * s, right[1] - 5.5 * s * Math.cos(1.3 * s), Math.max(-2.98, right[2] * (1 - 1.6 * s) - 1.4 * s)]); }
  const out = [];
  for (let i = 0; i < count; ++i) {
    const u = (i / (count - 1)) * (key.length - 1), j = Math.min(key.length - 2, Math.floor(u)), f = u - j;
    for (let a = 0; a < 3; ++a) out.push((key[j][a] * (1 - f) + key[j + 1][a] * f) * mm);
  }
  return out;
}

export function frameAt(time, id, duration) {
  const phase = time * 0.9, open = 0.5 + 0.5 * Math.sin(phase * 1.3);
  const left = [-3.1 - 0.9 * Math.sin(phase), 0.6 + 0.4 * Math.cos(phase), 2.2], right = [3.4 + 0.7 * Math.sin(phase + 1), -0.7 + 0.5 * Math.sin(phase), 2.3];
  const pose = (p, handle, opening) => ({ position: p.map((v) => v * mm), quaternion: looking(handle, opening) });
  const poses = [pose(left, [-0.6, -0.5, 0.7], [0, 1, 0.7]), pose(right, [0.6, -0.5, 0.7], [0, 1, 0.7]), pose([7, 9, 4], [0.5, 0.6, 0.7], [1, 0, -0.7])];
  const tension = 0.075 * (1 + Math.sin(phase * 0.8)), count = 150 + (Math.floor(time * 2) % 5) * 12, step = Math.min(kSteps.length, Math.floor((time / duration) * kSteps.length));
  const tool = (i, grasped) => ({ pose: poses[i], device_pose: poses[i], grip_angle: grasped >= 0 ? 0.004 : 0.2 * open, grip_force: grasped >= 0 ? 0.12 + 0.05 * open : 0, thread_force: grasped >= 0 ? tension : 0,
    force: [0, 0, 0], grasped, input_valid: true });
  const warnings = [];
  if (tension > 0.09) warnings.push({ level: "warn", code: "thread-tension", text: "The thread is pulled hard." });
  if (tension > 0.128) warnings.push({ level: "danger", code: "thread-overload", text: "The thread is about to break: ease off." });
  return {
    type: "frame", id, step: Math.round(time * 500), time, positions: threadPoints(left, right, count), tension: new Array(count - 1).fill(tension), contact: new Array(count).fill(0),
    tools: [tool(0, 3), tool(1, count - 40), tool(2, -1)], broken: false, break_edge: -1, cuts: [], overruns: 3, real_time_factor: 1,
    task: { step_name: kSteps[Math.min(step, kSteps.length - 1)], step_index: step, steps: kSteps, hint: `Now: ${kSteps[Math.min(step, kSteps.length - 1)]}, with the needle holder.`, elapsed: time, done: time >= duration, warnings },
    devices: [{ name: "demonstrator", state: "live", received: Math.round(time * 1000), lost: 0, corrupt: 0, rejected: 0 }],
  };
}

export function resultOf(session, duration) {
  const time = Array.from({ length: 300 }, (_, i) => (i * duration) / 299);
  const items = [["time", duration, "s", 18, 20, "38 s; full points below 25 s"], ["throws", 2, "-", 10, 10, "two throws laid"], ["knot", "square", "-", 25, 25, "the two throws turn against each other"],
    ["security", 0.11, "N", 15, 15, "held until the thread broke"], ["tail lengths", 2.6e-3, "m", 6, 10, "one tail 2.6 mm; 2 to 3 mm wanted, the other 4.1 mm"], ["path length", 0.214, "m", 7, 10, "both hands together; expert 0.15 m"],
    ["grip-force peak", 0.31, "N", 3, 5, "peak above 0.25 N"], ["thread overload", 0, "-", 5, 5, "never above 80 % of its strength"]];
  return {
    type: "result", session, task: "knot-square", title: "Square knot", finished: true, passed: true, seconds: duration,
    score: { total: 89, max_total: 100, items: items.map(([name, value, unit, points, max_points, why]) => ({ name, value, unit, points, max_points, why })) },
    knot: { class: "square", security_newton: 0.11, held: true },
    events: [["grasp", 0.11, 1], ["throw-laid", 0.4, -1], ["tightened", 0.55, -1], ["throw-laid", 0.75, -1], ["cut", 0.93, 1]].map(([name, share, tool]) => ({ time: share * duration, name, tool, value: 0.02, unit: name === "grasp" ? "N" : "-", text: "" })),
    series: [["grip_force_left", "Grip, left forceps", "N", (t) => 0.12 + 0.05 * Math.sin(t)], ["grip_force_right", "Grip, needle holder", "N", (t) => 0.1 + 0.08 * Math.abs(Math.sin(2 * t))],
      ["tension", "Thread tension", "N", (t) => 0.075 * (1 + Math.sin(0.7 * t))], ["speed_left", "Left tip", "m/s", (t) => 0.012 * Math.abs(Math.sin(3 * t))], ["speed_right", "Right tip", "m/s", (t) => 0.02 * Math.abs(Math.cos(2 * t))]]
      .map(([name, title, unit, f]) => ({ name, title, unit, time, value: time.map(f) })),
    paths: [0, 1].map((tool) => ({ tool, name: kScene.tools[tool].name, time, positions: time.flatMap((t) => frameAt(t, 0, duration).tools[tool].pose.position) })),
  };
}
