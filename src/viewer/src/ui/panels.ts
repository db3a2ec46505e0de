// The panels beside the field: steps and hint, timers, force bars, warnings, health. They show what a frame says.
import type { DeviceStatus, Frame, Scene, TaskState, Warning } from "../messages";
import { clear, h, setAttribute, setText } from "./dom";
import { clock, kLaboratory, milliNewton, words } from "./format";
import { icon } from "./pictures";

/// Where the pull on the thread stands against its strength. The words come with the colour, and the pattern with both.
export function tensionZone(tension: number, strength: number): "ok" | "high" | "near-break" {
  const share = strength > 0 ? tension / strength : 0;
  return share >= 0.85 ? "near-break" : share >= 0.6 ? "high" : "ok";
}

/// Full scale of a force bar: grows in round steps so that the bar never runs over.
export function barScale(newton: number, smallest = 0.2): number {
  let scale = smallest;
  for (let k = 0; scale < newton; ++k) scale *= k % 3 === 1 ? 2.5 : 2;
  return scale;
}

class Meter {
  readonly element: HTMLElement;
  private readonly fill = h("div", { class: "fill" });
  private readonly peakMark = h("div", { class: "peak" });
  private readonly value = h("output", {}, "");
  private readonly scaleText = h("span", { class: "scale" }, "");
  private scale: number;
  private peak = 0;

  /// `smallest` [N]: full scale of a bar that grows, at first.
  constructor(private readonly label: string, private readonly fixedScale: number | null, mark: string | null, private readonly smallest = 0.2) {
    this.scale = fixedScale ?? smallest;
    const track = h("div", { class: "track" }, this.fill, this.peakMark,
      mark ? h("div", { class: "limit", title: mark }) : null);
    this.element = h("div", { class: "meter", role: "meter", "aria-label": label, "aria-valuemin": 0 },
      h("span", { class: "label" }, label), this.value, track, this.scaleText);
  }

  show(newton: number, zone: string, zoneText: string): void {
    this.peak = Math.max(this.peak, newton);
    if (this.fixedScale === null) this.scale = Math.max(this.scale, barScale(this.peak, this.smallest));
    const share = Math.min(1, Math.max(0, newton / this.scale));
    this.fill.style.transform = `scaleX(${share.toFixed(3)})`;
    this.peakMark.style.left = `${(100 * Math.min(1, this.peak / this.scale)).toFixed(1)}%`;
    setAttribute(this.element, "data-zone", zone);
    const text = milliNewton(newton) + (zoneText ? ` · ${zoneText}` : "");
    setText(this.value, text);
    setText(this.scaleText, `0 – ${milliNewton(this.scale)} · peak ${milliNewton(this.peak)}`);
    setAttribute(this.element, "aria-valuenow", (newton * 1000).toFixed(1));
    setAttribute(this.element, "aria-valuemax", (this.scale * 1000).toFixed(0));
    setAttribute(this.element, "aria-valuetext", `${this.label} ${text}`);
  }
}

export function toolTitle(name: string): string {
  return words(name);
}

/// Force bars of the thread and of each instrument.
export class ForcePanel {
  readonly element = h("section", { class: "panel forces", "aria-label": "Forces" });
  private readonly thread: Meter;
  private readonly tools: { grip: Meter; pull: Meter; state: HTMLElement; box: HTMLElement }[];
  private readonly onTip: boolean;
  private readonly strength: number;

  constructor(scene: Scene) {
    this.strength = scene.thread_strength;
    this.onTip = !!scene.tissue; // of tissue and needle as well as of the thread
    this.thread = new Meter("Tension", scene.thread_strength > 0 ? 1.1 * scene.thread_strength : null,
      `breaks at ${milliNewton(scene.thread_strength)}`);
    const thread = !kLaboratory.includes(scene.task);
    if (thread) this.element.append(h("h2", {}, "Thread"), h("p", { class: "quiet" }, `${scene.suture} · ${(2e6 * scene.thread_radius).toFixed(0)} µm · breaks at ${milliNewton(scene.thread_strength)}`), this.thread.element);
    this.tools = scene.tools.map((tool, index) => {
      const grip = new Meter("Grip", null, null), pull = this.onTip ? new Meter("Pull on the tip", null, null, 0.005) : new Meter("Pull of the thread", null, null);
      const state = h("span", { class: "tag" }, "");
      const box = h("div", { class: "tool" }, h("h2", {}, h("span", { class: `bands b${index}`, "aria-hidden": "true" }), toolTitle(tool.name), state), ...(tool.kind === "scissors" ? [] : thread ? [grip.element, pull.element] : [grip.element]));
      this.element.append(box);
      return { grip, pull, state, box };
    });
  }

  show(frame: Frame, active: number | null): void {
    let tension = 0;
    for (const value of frame.tension) tension = Math.max(tension, value);
    const zone = tensionZone(tension, this.strength);
    this.thread.show(tension, frame.broken ? "near-break" : zone, frame.broken ? "broken" : zone === "ok" ? "" : zone === "high" ? "high" : "near limit");
    this.tools.forEach((parts, i) => {
      const tool = frame.tools[i];
      if (!tool) return;
      parts.grip.show(tool.grip_force, "ok", "");
      parts.pull.show(this.onTip ? Math.hypot(...tool.force) : tool.thread_force, "ok", "");
      setText(parts.state, !tool.input_valid ? "no input" : tool.grasped >= 0 ? "holding" : "");
      parts.state.classList.toggle("alarm", !tool.input_valid);
      parts.box.classList.toggle("active", active === i);
    });
  }
}

export class StepPanel {
  readonly element: HTMLElement;
  private readonly list = h("ol", { class: "steps" });
  private readonly hint = h("p", { class: "hint", "aria-live": "polite" }, "");
  private readonly time = h("output", { class: "time", "aria-label": "Time" }, "0:00.0");
  private readonly stepTime = h("output", { class: "steptime", "aria-label": "Time in this step" }, "");
  private known = "";
  private step = -1;
  private stepSince = 0;

  constructor(title: string) {
    this.element = h("section", { class: "panel task", "aria-label": "Task" },
      h("h2", {}, title), h("div", { class: "timers" }, this.time, this.stepTime), h("div", { class: "hintbox" }, h("h3", {}, "Do now"), this.hint), this.list);
  }

  show(task: TaskState | null, sceneTime: number): void {
    if (!task) { setText(this.time, clock(sceneTime)); return; }
    setText(this.time, clock(task.elapsed));
    if (task.step_index !== this.step) { this.step = task.step_index; this.stepSince = task.elapsed; }
    setText(this.stepTime, task.done ? "" : `this step ${clock(Math.max(0, task.elapsed - this.stepSince))}`);
    setText(this.hint, task.done ? "Task ended." : task.hint);
    const key = `${task.step_index}|${task.steps.join("|")}`;
    if (key === this.known) return;
    this.known = key;
    clear(this.list);
    task.steps.forEach((name, i) => {
      const state = i < task.step_index ? "done" : i === task.step_index ? "now" : "ahead";
      const mark = state === "done" ? "✓" : state === "now" ? "▶" : String(i + 1);
      this.list.append(h("li", { class: state, "aria-current": state === "now" ? "step" : null },
        h("span", { class: "mark", "aria-hidden": "true" }, mark), words(name), h("span", { class: "sr" }, state === "done" ? " (done)" : "")));
    });
  }
}

const kLevels = { info: "Note", warn: "Caution", danger: "Stop" } as const;

/// Warnings: outline, icon, word, pattern and (if wanted) a sound; colour only in addition.
export class WarningList {
  readonly element = h("div", { class: "warnings", role: "alert", "aria-live": "assertive" });
  onnew: (level: Warning["level"]) => void = () => {};
  private known = "";
  private codes = new Set<string>();

  show(warnings: readonly Warning[]): void {
    const key = warnings.map((w) => `${w.level}${w.code}${w.text}`).join("|");
    if (key === this.known) return;
    this.known = key;
    clear(this.element);
    for (const warning of warnings) {
      if (!this.codes.has(warning.code)) this.onnew(warning.level);
      this.element.append(h("div", { class: `warning ${warning.level}`, "data-code": warning.code },
        icon[warning.level](), h("strong", {}, kLevels[warning.level]), h("span", {}, warning.text)));
    }
    this.codes = new Set(warnings.map((w) => w.code));
  }
}

const kDeviceStates: Record<DeviceStatus["state"], string> = {
  waiting: "waiting for a first sample", live: "live", stale: "silent for a moment", lost: "lost", finished: "ended",
};

/// How machine and devices are: one quiet line each.
export class HealthPanel {
  readonly element = h("section", { class: "panel health", "aria-label": "Machine and devices" });
  private readonly rate = h("p", {}, "");
  private readonly list = h("ul", {});

  constructor() { this.element.append(this.rate, this.list); }

  show(frame: Frame): void {
    const slow = frame.real_time_factor < 0.97;
    setText(this.rate, `${slow ? "△ Slower than real time" : "Real time"}: ${(100 * frame.real_time_factor).toFixed(0)} %, ${frame.overruns} late steps`);
    this.rate.classList.toggle("alarm", slow);
    while (this.list.children.length > frame.devices.length) this.list.lastElementChild!.remove();
    frame.devices.forEach((device, i) => {
      const row = this.list.children[i] ?? this.list.appendChild(h("li"));
      const bad = device.state === "lost" || device.state === "stale";
      const losses = [[device.lost, "lost"], [device.corrupt, "corrupt"], [device.rejected, "rejected"]]
        .filter(([count]) => Number(count) > 0).map(([count, what]) => `${count} ${what}`).join(", ");
      setText(row, `${bad ? "△ " : ""}${device.name}: ${kDeviceStates[device.state]}${losses ? ` (${losses})` : ""}`);
      row.classList.toggle("alarm", bad);
    });
  }
}
