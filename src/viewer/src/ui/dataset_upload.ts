// Adds a folder of measurements to those that the trainer can reconcile.
import { chosen, send } from "../net/upload";
import { h, setText } from "./dom";

export class DatasetUpload {
  readonly element = h("div", { class: "upload" });
  private readonly choice = h("input", { type: "file", id: "measurements", multiple: true, webkitdirectory: true, onchange: () => void this.begin() });
  private readonly progress = h("progress", { max: 1, value: 0, "aria-label": "Progress of sending" });
  private readonly cancel = h("button", { class: "cancel-upload", onclick: () => this.running?.abort() }, "Cancel sending");
  private readonly said = h("p", { role: "status", "aria-live": "polite" }, "");
  private running: AbortController | undefined;

  constructor() {
    this.element.append(h("label", { for: "measurements" }, "Add a folder of measurements (experiment.yaml and its tables): "), this.choice, h("div", { class: "job" }, this.progress, this.cancel), this.said);
    this.busy(false);
  }

  /// The page goes: what is half sent is taken back.
  dispose(): void { this.running?.abort(); }

  private busy(on: boolean): void {
    this.progress.hidden = this.cancel.hidden = !on;
    this.choice.disabled = on;
  }

  private async begin(): Promise<void> {
    const folder = chosen(this.choice.files ?? []);
    this.choice.value = ""; // the same folder may be chosen again
    if (folder.dataset === "") return;
    const running = this.running = new AbortController();
    this.busy(true);
    this.progress.value = 0;
    setText(this.said, `${folder.dataset}: sending …`);
    try {
      await send(folder, (share) => { this.progress.value = share; }, running.signal);
      setText(this.said, `${folder.dataset} is there.${folder.left.length > 0 ? ` Left out: ${folder.left.slice(0, 5).join(", ")}${folder.left.length > 5 ? " …" : ""}.` : ""}`);
    } catch (error) {
      setText(this.said, running.signal.aborted ? `${folder.dataset}: cancelled; nothing was kept.` : `${folder.dataset} was refused: ${(error as Error).message}`);
    }
    this.running = undefined;
    this.busy(false);
  }
}
