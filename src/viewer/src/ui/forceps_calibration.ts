// The guided calibration of the forceps: which openings and loads are to be set, one after the other, each read when the trainee says that it
// is set; the last one can be taken back. Fit, reasons and file are the trainer's.
import { calibration, type CalibrationFit, type CalibrationPoint, type CalibrationStatus } from "../net/api";
import { h, setText } from "./dom";

type Run = NonNullable<CalibrationStatus["run"]>;
const kNumbers = /^[\s,;]*(-?\d+(\.\d+)?[\s,;]+)*-?\d+(\.\d+)?[\s,;]*$/;

/// "0, 5 10" to [0, 5, 10]; nothing where there is something else.
export function numbersOf(text: string): number[] | undefined {
  return kNumbers.test(text) ? text.split(/[\s,;]+/).filter((word) => word !== "").map(Number) : undefined;
}

export class ForcepsCalibration {
  readonly element = h("section", { class: "panel calibrate", "aria-labelledby": "calibrate-title" });
  private readonly trouble = h("p", { class: "trouble", role: "alert" }, "");
  private readonly live = h("output", { class: "live-count" }, "");
  private readonly reading = h("progress", { max: 1, value: 0, "aria-label": "Share of this reading" });
  private shown = "";
  running = false;

  constructor() {
    this.element.addEventListener("keydown", (event) => {
      if (event.key !== "Backspace" || event.target instanceof HTMLInputElement) return;
      event.preventDefault();
      if (this.element.querySelector("[data-step=undo]")) void this.step("undo");
    });
  }

  /// What changes all the time is changed in place; the rest is drawn anew when it differs, so that no click falls between two buttons.
  show(status: CalibrationStatus): void {
    const run = status.run;
    this.running = run?.state === "asking" || run?.state === "reading";
    this.reading.value = run?.progress ?? 0;
    setText(this.live, run && (run.state === "asking" || run.state === "reading") ? (run.live === null ? "no reading: silent, or its wire is broken" : `${run.live.toFixed(0)} counts now`) : "");
    const key = JSON.stringify({ ...status, run: run && { ...run, live: 0, progress: 0 } });
    if (key === this.shown) return;
    this.shown = key;
    const focus = (document.activeElement as HTMLElement | null)?.dataset.step;
    const inUse = h("p", { class: "quiet" }, `In use: ${status.in_use || "as built (models/forceps/default.yaml)"}.`);
    const content = !status.port ? [h("p", {}, "No forceps are attached: start the trainer with --serial PATH.")] : run ? this.guide(run) : this.beginning(status.port);
    this.element.replaceChildren(h("h2", { id: "calibrate-title" }, "Calibration of the forceps"), inUse, ...content, this.trouble);
    if (run) setText(this.trouble, run.trouble);
    if (focus) this.element.querySelector<HTMLElement>(`[data-step="${focus}"]`)?.focus();
  }

  private async step(what: "start" | "read" | "undo" | "stop" | "use", wish: object = {}): Promise<void> {
    try {
      setText(this.trouble, "");
      this.show(await calibration.change(what, wish));
    } catch (error) { setText(this.trouble, (error as Error).message); }
  }

  private beginning(port: string): HTMLElement[] {
    const text = (value: string) => h("input", { type: "text", maxlength: 80, value });
    const whole = (value: number, most: number, least = 1) => h("input", { type: "number", min: least, max: most, value });
    const name = text("forceps"), sensor = text("unknown"), identity = whole(1, 2147483647), repeats = whole(2, 20, 2);
    const angles = text("0, 5, 10, 15, 20, 25"), forces = text("0, 0.2, 0.5, 1, 2, 3");
    const begin = (): void => {
      const [a, f] = [numbersOf(angles.value), numbersOf(forces.value)];
      if (!a || !f) { setText(this.trouble, "Openings and loads are numbers with commas between them."); return; }
      void this.step("start", { name: name.value, sensor: sensor.value, identity: Number(identity.value), repeats: Number(repeats.value), angles: a, forces: f });
    };
    return [h("p", {}, `Handle on ${port}. Each opening and each load is set from below and from above; a reading takes half a second.`),
      h("div", { class: "calibration-form" }, ...([["Name of the handle", name], ["Serial number of its sensor", sensor], ["Identity of this calibration, as stored in the handle", identity],
        ["Openings to set [deg]", angles], ["Loads to put on the pad [N]", forces], ["Times each value is taken", repeats]] as const).map(([label, field]) => h("label", { class: "line-input" }, label, field))),
      h("button", { "data-step": "go", class: "primary", onclick: begin }, "Start calibration")];
  }

  private guide(run: Run): HTMLElement[] {
    const plots = h("div", { class: "calibration-plots" }, pointsPlot("Opening [deg]", run.angle, run.fits?.angle), pointsPlot("Load [N]", run.force, run.fits?.force));
    if (run.state === "asking" || run.state === "reading") {
      return [h("p", {}, `${run.taken} of ${run.of} values `, h("progress", { max: run.of, value: run.taken, "aria-label": "Values taken" })),
        h("p", { class: "instruction", role: "status", "aria-live": "assertive" }, run.state === "reading" ? "Hold it … reading" : `${run.instruction}.`),
        h("p", { class: "live" }, this.live, this.reading),
        h("div", { class: "buttons" }, h("button", { "data-step": "go", class: "primary", "aria-disabled": run.state === "reading", onclick: () => void this.step("read") }, "It is set: read (Enter)"),
          h("button", { "data-step": "undo", disabled: run.taken === 0 && run.state !== "reading", onclick: () => void this.step("undo") }, "Take the last one back (Backspace)"),
          h("button", { "data-step": "stop", onclick: () => void this.step("stop") }, "Stop")), plots];
    }
    const done = run.state === "done", fits = run.fits!;
    return [h("p", { class: "instruction", role: "status" }, done ? "The calibration is accepted." : "The calibration is refused."),
      ...(["angle", "force"] as const).filter((name) => !fits[name].good).map((name) => h("p", { class: "refused" }, `${name}: refused: ${fits[name].why}`)), fitTable(fits),
      h("div", { class: "buttons" }, done ? h("button", { "data-step": "go", class: "primary", onclick: () => void this.step("use") }, "Use it from now on") : null,
        h("button", { "data-step": "stop", onclick: () => void this.step("stop") }, "Close")),
      run.file ? h("p", {}, "Kept as ", h("code", {}, run.file)) : h("span", {}), plots];
  }
}

function fitTable(fits: { angle: CalibrationFit; force: CalibrationFit }): HTMLElement {
  const rows = (["angle", "force"] as const).filter((name) => fits[name].good).map((name) => {
    const f = fits[name], two = (value: number) => h("td", { class: "number" }, value.toPrecision(2));
    return h("tr", {}, h("th", { scope: "row" }, `${name} [${f.unit}]`), h("td", { class: "number" }, `${f.gain.toPrecision(4)} a count`), two(f.uncertainty), two(f.residual), two(f.hysteresis), two(f.repeatability),
      h("td", { class: "number" }, `${f.from.toPrecision(3)} to ${f.to.toPrecision(3)}`));
  });
  const head = ["", "Gain", "Uncertainty (1 s.d.)", "Residual", "Hysteresis", "Repeatability", "Valid"].map((text) => h("th", { scope: "col" }, text));
  return rows.length > 0 ? h("table", { class: "fits" }, h("thead", {}, h("tr", {}, ...head)), h("tbody", {}, ...rows)) : h("span", {});
}

/// Counts against the value that was set: up as a filled mark, down as an open one, with the line that was fitted.
function pointsPlot(label: string, points: CalibrationPoint[], fit?: { good: boolean; gain: number; zero: number }): SVGElement {
  const ns = "http://www.w3.org/2000/svg", make = (name: string, attributes: Record<string, string | number>, text = ""): SVGElement => {
    const element = document.createElementNS(ns, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
    element.textContent = text;
    return element;
  };
  const plot = make("svg", { viewBox: "0 0 320 200", class: "points", role: "img", "aria-label": `${label}: ${points.length} values taken` });
  plot.append(make("text", { x: 160, y: 196, "text-anchor": "middle" }, label), make("text", { x: 4, y: 12 }, "counts"), make("path", { d: "M40 16V172H312", class: "axis" }));
  if (points.length === 0) return plot;
  const span = (values: number[]): [number, number] => { const low = Math.min(...values), high = Math.max(...values); return high > low ? [low, high] : [low - 1, high + 1]; };
  const [v0, v1] = span(points.map((p) => p.value)), [c0, c1] = span(points.map((p) => p.count));
  const x = (value: number) => 48 + ((value - v0) / (v1 - v0)) * 256, y = (count: number) => 166 - ((count - c0) / (c1 - c0)) * 144;
  if (fit?.good) plot.append(make("path", { class: "fit", d: `M${x(v0)} ${y(v0 / fit.gain + fit.zero)}L${x(v1)} ${y(v1 / fit.gain + fit.zero)}` }));
  for (const p of points) plot.append(make("circle", { cx: x(p.value), cy: y(p.count), r: 4, class: p.upwards ? "up" : "down" }));
  plot.append(make("text", { x: 2, y: 24 }, c1.toFixed(0)), make("text", { x: 2, y: 170 }, c0.toFixed(0)), make("text", { x: 48, y: 184 }, v0.toPrecision(3)), make("text", { x: 304, y: 184, "text-anchor": "end" }, v1.toPrecision(3)));
  return plot;
}
