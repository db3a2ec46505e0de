// The laboratory: measurements against the model (reconcile), and the guided calibrations of the forceps and of a camera. Asks the trainer
// twice a second; everything is decided there.
import type { App, Page } from "../app";
import { calibration, reconcile, type ReconcileStatus } from "../net/api";
import { CameraCalibration } from "./camera_calibration";
import { DatasetUpload } from "./dataset_upload";
import { h, setText } from "./dom";
import { ForcepsCalibration } from "./forceps_calibration";

const kEvery = 500, kSoon = 150; // [ms]
const kVerdicts: Record<string, string> = {
  agree: "agrees", parameter: "a parameter differs", effect: "effect named", ambiguous: "cannot be told apart", unknown: "something unnamed is missing",
};

export class LaboratoryPage implements Page {
  readonly title = "Laboratory";
  readonly element = h("div", { class: "page laboratory" });
  private readonly reconciling = h("section", { class: "panel reconcile", "aria-labelledby": "reconcile-title" });
  private readonly forceps = new ForcepsCalibration();
  private readonly camera = new CameraCalibration();
  private readonly upload = new DatasetUpload();
  private readonly progress = h("progress", { max: 1, value: 0, "aria-label": "Progress of reconcile" });
  private readonly said = h("p", { role: "status", "aria-live": "polite" }, "");
  private readonly cancel = h("button", { class: "cancel", onclick: () => void this.changed(() => reconcile.cancel()) }, "Cancel");
  private readonly datasets = h("div", { class: "datasets" });
  private readonly report = h("div", { class: "report" });
  private timer: number | undefined;
  private listed = "";
  private gone = false;

  constructor(_app: App) {
    this.reconciling.append(h("h2", { id: "reconcile-title" }, "Measurements against the model"),
      h("p", { class: "quiet" }, "Finds where a measured experiment and its model disagree, and names the missing effect, or says that none can be named."),
      this.datasets, this.upload.element, h("div", { class: "job" }, this.progress, this.cancel), this.said, this.report);
    this.element.append(h("h1", {}, "Laboratory"), this.reconciling, this.forceps.element, this.camera.element);
    this.progress.hidden = this.cancel.hidden = true;
    void this.look();
  }

  dispose(): void { this.gone = true; window.clearTimeout(this.timer); this.camera.dispose(); this.upload.dispose(); }

  private async look(): Promise<void> {
    try {
      const [jobs, handle] = await Promise.all([reconcile.status(), calibration.status()]);
      this.showJobs(jobs);
      this.forceps.show(handle);
    } catch (error) {
      setText(this.said, `The laboratory does not answer: ${(error as Error).message}.`);
    }
    if (!this.gone) this.timer = window.setTimeout(() => void this.look(), this.forceps.running ? kSoon : kEvery);
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
      : h("p", {}, "There are no measurements yet: add a folder below, or put folders with an experiment.yaml into ", h("code", {}, status.folder), "."));
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
}
