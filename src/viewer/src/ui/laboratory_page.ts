// The laboratory: measurements against the model (reconcile), and the guided calibration of the forceps. Asks the trainer twice a
// second while something runs; everything is decided there.
import type { App, Page } from "../app";
import { calibration, reconcile, type CalibrationPoint, type CalibrationStatus, type ReconcileStatus } from "../net/api";
import { h, setText } from "./dom";

const kEvery = 500; // [ms]
const kVerdicts: Record<string, string> = {
  agree: "agrees", parameter: "a parameter differs", effect: "effect named", ambiguous: "cannot be told apart", unknown: "something unnamed is missing",
};

export class LaboratoryPage implements Page {
  readonly title = "Laboratory";
  readonly element = h("div", { class: "page laboratory" });
  private readonly reconciling = h("section", { class: "panel reconcile", "aria-labelledby": "reconcile-title" });
  private readonly calibrating = h("section", { class: "panel calibrate", "aria-labelledby": "calibrate-title" });
  private readonly progress = h("progress", { max: 1, value: 0, "aria-label": "Progress of reconcile" });
  private readonly said = h("p", { role: "status", "aria-live": "polite" }, "");
  private readonly cancel = h("button", { class: "cancel", onclick: () => void this.changed(() => reconcile.cancel()) }, "Cancel");
  private readonly datasets = h("div", { class: "datasets" });
  private readonly report = h("div", { class: "report" });
  private timer: number | undefined;
  private listed = "";
  private guided = "";
  private gone = false;

  constructor(_app: App) {
    this.reconciling.append(h("h2", { id: "reconcile-title" }, "Measurements against the model"),
      h("p", { class: "quiet" }, "Finds where a measured experiment and its model disagree, and names the missing effect, or says that none can be named."),
      this.datasets, h("div", { class: "job" }, this.progress, this.cancel), this.said, this.report);
    this.element.append(h("h1", {}, "Laboratory"), this.reconciling, this.calibrating);
    this.progress.hidden = this.cancel.hidden = true;
    void this.look();
  }

  dispose(): void { this.gone = true; window.clearTimeout(this.timer); }

  private async look(): Promise<void> {
    try {
      const [jobs, handle] = await Promise.all([reconcile.status(), calibration.status()]);
      this.showJobs(jobs);
      this.showCalibration(handle);
    } catch (error) {
      setText(this.said, `The laboratory does not answer: ${(error as Error).message}.`);
    }
    if (!this.gone) this.timer = window.setTimeout(() => void this.look(), kEvery);
  }

  private async changed(ask: () => Promise<ReconcileStatus>): Promise<void> {
    try { this.showJobs(await ask()); } catch (error) { setText(this.said, (error as Error).message); }
  }

  private showJobs(status: ReconcileStatus): void {
    const { job } = status, running = job.state === "running";
    this.progress.hidden = this.cancel.hidden = !running;
    this.progress.value = job.share;
    const words: Record<string, string> = { idle: "", running: `${job.dataset}: ${job.stage} …`, done: `${job.dataset}: ${job.message}`, cancelled: `${job.dataset}: cancelled.`, failed: `${job.dataset} was refused: ${job.message}` };
    setText(this.said, words[job.state] ?? job.state);
    const key = JSON.stringify([status.datasets, running]);
    if (key === this.listed) return; // the table keeps its focus
    this.listed = key;
    const focus = (document.activeElement as HTMLElement | null)?.dataset.start;
    this.datasets.replaceChildren(status.datasets.length > 0 ? this.table(status, running)
      : h("p", {}, "There are no measurements yet: put folders with an experiment.yaml into ", h("code", {}, status.folder), "."));
    if (focus) this.datasets.querySelector<HTMLElement>(`[data-start="${CSS.escape(focus)}"]`)?.focus();
  }

  private table(status: ReconcileStatus, running: boolean): HTMLElement {
    const rows = status.datasets.map(({ name, report }) => {
      const verdict = report ? `${kVerdicts[report.verdict] ?? report.verdict}${report.effects.length > 0 ? `: ${report.effects.join(", ")}` : ""}${report.partial ? " (and more)" : ""}` : "not looked at yet";
      return h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, verdict), h("td", { class: "links" },
        h("button", { "data-start": name, disabled: running, "aria-label": `Reconcile ${name}`, onclick: () => void this.changed(() => reconcile.start(name)) }, report ? "Again" : "Reconcile"),
        report ? h("button", { "data-report": name, "aria-label": `Report of ${name}`, onclick: () => this.open(name, report.model) }, "Report") : null));
    });
    return h("table", {}, h("thead", {}, h("tr", {}, ...["Measurements", "Verdict", ""].map((text) => h("th", { scope: "col" }, text)))), h("tbody", {}, ...rows));
  }

  private open(name: string, model: boolean): void {
    const at = `/documents/reconcile/${encodeURIComponent(name)}`;
    this.report.replaceChildren(h("p", {}, h("a", { href: `${at}/report.html`, target: "_blank" }, "Open the report by itself"),
      model ? h("span", {}, " · ", h("a", { href: `${at}/model.yaml`, target: "_blank" }, "model.yaml"), " (for filum train --model)") : null),
      h("iframe", { class: "document", src: `${at}/report.html`, title: `Report of ${name}` }));
    this.report.scrollIntoView({ block: "nearest" });
  }

  // ---- calibration

  private async step(what: "start" | "read" | "stop" | "use", wish: object = {}): Promise<void> {
    try {
      this.guided = "";
      this.showCalibration(await calibration.change(what, wish));
    } catch (error) {
      const trouble = this.calibrating.querySelector(".trouble");
      if (trouble) setText(trouble, (error as Error).message);
    }
  }

  private showCalibration(status: CalibrationStatus): void {
    const key = JSON.stringify(status);
    if (key === this.guided) return;
    this.guided = key;
    const focus = (document.activeElement as HTMLElement | null)?.dataset.step;
    const title = h("h2", { id: "calibrate-title" }, "Calibration of the forceps");
    const inUse = h("p", { class: "quiet" }, `In use: ${status.in_use || "as built (models/forceps/default.yaml)"}.`);
    if (!status.port) this.calibrating.replaceChildren(title, inUse, h("p", {}, "No forceps are attached: start the trainer with --serial PATH."), h("p", { class: "trouble", role: "alert" }, ""));
    else this.calibrating.replaceChildren(title, inUse, ...(status.run ? this.guide(status.run) : this.beginning(status.port)), h("p", { class: "trouble", role: "alert" }, status.run?.trouble ?? ""));
    if (focus) this.calibrating.querySelector<HTMLElement>(`[data-step="${focus}"]`)?.focus();
  }

  private beginning(port: string): HTMLElement[] {
    const sensor = h("input", { type: "text", maxlength: 40, value: "unknown" });
    const repeats = h("input", { type: "number", min: 1, max: 20, value: 2 });
    return [h("p", {}, `Handle on ${port}. Openings from 0 to 25 degrees and loads from 0 to 3 N are asked for, each from below and from above.`),
      h("label", { class: "line-input" }, "Serial number of the handle", sensor), h("label", { class: "line-input" }, "Times each value is taken", repeats),
      h("button", { "data-step": "go", class: "primary", onclick: () => void this.step("start", { sensor: sensor.value, repeats: Number(repeats.value) }) }, "Start calibration")];
  }

  private guide(run: NonNullable<CalibrationStatus["run"]>): HTMLElement[] {
    const stop = h("button", { "data-step": "stop", onclick: () => void this.step("stop") }, run.state === "done" || run.state === "refused" ? "Close" : "Stop");
    const plots = h("div", { class: "calibration-plots" }, pointsPlot("Opening [deg]", run.angle, run.fits?.angle), pointsPlot("Load [N]", run.force, run.fits?.force));
    if (run.state === "asking" || run.state === "reading") {
      return [h("p", {}, `${run.taken} of ${run.of} values`), h("p", { class: "instruction", role: "status", "aria-live": "assertive" }, run.state === "reading" ? "Hold it … reading" : `${run.instruction}.`),
        h("div", { class: "buttons" }, h("button", { "data-step": "go", class: "primary", "aria-disabled": run.state === "reading", onclick: () => void this.step("read") }, "It is set: read"), stop), plots];
    }
    const lines = (["angle", "force"] as const).map((name) => {
      const fit = run.fits![name];
      return h("p", {}, `${name}: `, fit.good ? `${fit.gain.toPrecision(4)} ${fit.unit} a count, uncertainty ${fit.uncertainty.toPrecision(2)} ${fit.unit} (hysteresis ${fit.hysteresis.toPrecision(2)}, repeatability ${fit.repeatability.toPrecision(2)})` : `refused: ${fit.why}`);
    });
    return [h("p", { class: "instruction", role: "status" }, run.state === "done" ? "The calibration is accepted." : "The calibration is refused."), ...lines,
      h("div", { class: "buttons" }, run.state === "done" ? h("button", { "data-step": "go", class: "primary", onclick: () => void this.step("use") }, "Use it from now on") : null, stop),
      run.file ? h("p", {}, "Kept as ", h("code", {}, run.file)) : h("span", {}), plots];
  }
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
