// The guided calibration of a camera: its picture with what was covered so far, what to show next, and the result. Views are taken by the
// guide when the board is held still; nothing needs a hand at the keyboard.
import { camera, type CameraStatus } from "../net/api";
import { h, setText } from "./dom";

const kEvery = 250; // [ms] while it runs

export class CameraCalibration {
  readonly element = h("section", { class: "panel camera", "aria-labelledby": "camera-title" });
  private readonly body = h("div", {});
  private readonly trouble = h("p", { class: "trouble", role: "alert" }, "");
  private readonly instruction = h("p", { class: "instruction", role: "status", "aria-live": "polite" }, "");
  private readonly picture = h("img", { class: "preview", alt: "The camera's picture; parts that were covered are tinted, the board's corners are marked" }) as HTMLImageElement;
  private readonly board = h("p", { class: "quiet" }, "");
  private readonly wishes = h("ul", { class: "wishes" });
  private readonly finish = h("button", { "data-camera": "calibrate", class: "primary", onclick: () => void this.change("calibrate") }, "Calibrate");
  private readonly undo = h("button", { "data-camera": "undo", onclick: () => void this.change("undo") }, "Take the last view back");
  private timer: number | undefined;
  private drawn = "";
  private listed = "";
  private seen = -1;
  private gone = false;

  constructor() {
    this.element.append(h("h2", { id: "camera-title" }, "Calibration of a camera"), this.body, this.trouble);
    void this.look();
  }

  dispose(): void { this.gone = true; window.clearTimeout(this.timer); }

  private async look(): Promise<void> {
    window.clearTimeout(this.timer);
    try { this.show(await camera.status()); } catch (error) { setText(this.trouble, (error as Error).message); }
    if (!this.gone && this.drawn === "guide") this.timer = window.setTimeout(() => void this.look(), kEvery);
  }

  private async change(what: "start" | "undo" | "calibrate" | "stop", wish: object = {}): Promise<void> {
    try {
      setText(this.trouble, "");
      this.show(await camera.change(what, wish));
      void this.look();
    } catch (error) { setText(this.trouble, (error as Error).message); }
  }

  private show(status: CameraStatus): void {
    const run = status.run;
    const what = !status.there ? "none" : !run ? "begin" : run.state === "failed" || run.state === "done" ? run.state : "guide";
    if (what !== this.drawn) {
      this.drawn = what;
      this.listed = "";
      if (what === "begin") this.seen = -1;
      this.body.replaceChildren(...this.draw(what, status));
    }
    if (!run) return;
    setText(this.trouble, run.trouble ?? "");
    if (what === "guide") this.follow(run);
  }

  private draw(what: string, status: CameraStatus): HTMLElement[] {
    const stop = (text: string) => h("button", { "data-camera": "stop", onclick: () => void this.change("stop") }, text);
    if (what === "none") return [h("p", {}, "The camera tracker is not built here: it needs OpenCV (", h("code", {}, "libopencv-dev libopencv-contrib-dev"), ").")];
    if (what === "begin") {
      const number = h("input", { type: "number", min: 0, max: 99, value: 0 }), square = h("input", { type: "number", min: 1, max: 200, step: "any", value: 10 }), name = h("input", { type: "text", maxlength: 40, value: "camera" });
      return [h("p", {}, "Print a chessboard with 9 by 6 inner corners, glue it on something flat and measure its squares. Then hold it before the camera: views are taken by themselves when it rests."),
        h("div", { class: "calibration-form" }, status.fixed ? h("p", {}, "From ", h("code", {}, status.fixed)) : h("label", { class: "line-input" }, "Number of the camera", number),
          h("label", { class: "line-input" }, "Side of a square [mm]", square), h("label", { class: "line-input" }, "Name of the camera", name)),
        h("button", { "data-camera": "start", class: "primary", onclick: () => void this.change("start", { source: Number(number.value), square: Number(square.value), name: name.value }) }, "Start calibration")];
    }
    if (what === "failed") return [h("p", { class: "instruction" }, "The camera cannot be used."), stop("Close")];
    if (what === "done") {
      const r = status.run!.result!, u = r.uncertainty, px = (value: number, deviation: number) => `${value.toFixed(1)} ± ${deviation.toFixed(1)} px`;
      const rows: [string, string][] = [["Residual", `${r.residual_px.toFixed(3)} px rms over ${r.views} views`], ["Part of the picture covered", `${(100 * r.coverage).toFixed(0)} %`],
        ["Focal length", `${px(r.fx, u[0])}, ${px(r.fy, u[1])}`], ["Centre", `${px(r.cx, u[2])}, ${px(r.cy, u[3])}`], ["Distortion k1 k2 p1 p2 k3", r.distortion.map((d) => d.toPrecision(3)).join(", ")], ["Picture", `${r.width} x ${r.height}`]];
      return [h("p", { class: "instruction", role: "status" }, "The camera is calibrated."), h("table", {}, h("tbody", {}, ...rows.map(([name, value]) => h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, value))))),
        h("p", {}, "Kept as ", h("code", {}, status.run!.file ?? ""), "; track with ", h("code", {}, `filum_camera track --camera ${status.run!.file ?? ""}`)), stop("Close")];
    }
    return [this.instruction, h("div", { class: "guide" }, this.picture, this.wishes), this.board, h("div", { class: "buttons" }, this.finish, this.undo, stop("Stop"))];
  }

  private follow(run: NonNullable<CameraStatus["run"]>): void {
    setText(this.instruction, run.state === "starting" ? "The camera is being opened …" : run.state === "ended" ? "The video is over: calibrate, or stop." : `${run.instruction}.`);
    const b = run.board;
    setText(this.board, b ? `${run.views} views. The board now: ${(100 * b.size).toFixed(0)} % of the picture's width, tilted by about ${b.tilt_x_deg.toFixed(0)}° sideways and ${b.tilt_y_deg.toFixed(0)}° up and down.` : `${run.views ?? 0} views. The board is not to be seen whole.`);
    this.finish.classList.toggle("ready", run.complete === true);
    (this.undo as HTMLButtonElement).disabled = !run.views;
    this.picture.hidden = this.seen < 0 && !run.picture;
    if (run.picture !== undefined && run.picture !== this.seen && run.picture > 0) this.picture.src = `/documents/camera/preview.jpg?${(this.seen = run.picture)}`;
    const key = JSON.stringify(run.wishes);
    if (key === this.listed || !run.wishes) return;
    this.listed = key;
    this.wishes.replaceChildren(...run.wishes.map((w) => h("li", { class: w.granted ? "granted" : "" }, `${w.granted ? "✓" : "○"} ${w.what}`)));
  }
}
