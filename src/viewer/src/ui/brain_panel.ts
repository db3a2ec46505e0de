// The panel of brain retraction: pressure with its legend in mmHg, dose, timer, exposure, what each blade does, and how the
// pressure is coloured. Every state is said in words beside its colour; the limits' label and version are always shown.
import type { Frame, Scene } from "../messages";
import { kPressureStops, pressureView, type PressureMode } from "../scene/brain";
import { clock } from "./format";
import { SectionView } from "./section_view";
import { h, setAttribute, setText } from "./dom";

const kModes: [PressureMode, string][] = [["scale", "Full scale"], ["threshold", "Red only"], ["off", "Off"]];
const kWords: Record<string, string> = { green: "fine", yellow: "watch", orange: "high", red: "too high" };

/// Share of a bar that `value` fills, 0 to 1.
export function share(value: number, full: number): number { return full > 0 ? Math.min(1, Math.max(0, value / full)) : 0; }

function css([r, g, b]: [number, number, number]): string { return `rgb(${[r, g, b].map((c) => Math.round(255 * c)).join(" ")})`; }

/// A bar with a line at every limit of its bands and the limits' numbers below.
class Bar {
  private readonly fill = h("div", { class: "fill" });
  private readonly value = h("output", {}, "");
  private readonly track = h("div", { class: "track" }, this.fill);
  private readonly numbers = h("div", { class: "scale", "aria-hidden": "true" });
  private marked = "";
  readonly element: HTMLElement;

  constructor(private readonly label: string, private readonly unit: string) {
    this.element = h("div", { class: "meter brainmeter", role: "meter", "aria-label": label, "aria-valuemin": 0 },
      h("span", { class: "label" }, label), this.value, this.track, this.numbers);
  }

  show(value: number, band: string, bands: number[], full: number): void {
    this.mark(bands, full);
    this.fill.style.transform = `scaleX(${share(value, full).toFixed(3)})`;
    setAttribute(this.element, "data-band", band);
    const text = `${value.toFixed(value < 100 ? 1 : 0)} ${this.unit} · ${kWords[band] ?? band}`;
    setText(this.value, text);
    setAttribute(this.element, "aria-valuenow", value.toFixed(1));
    setAttribute(this.element, "aria-valuemax", full.toFixed(0));
    setAttribute(this.element, "aria-valuetext", `${this.label} ${text}`);
  }

  private mark(bands: number[], full: number): void {
    const key = [...bands, full].join();
    if (key === this.marked) return;
    this.marked = key;
    const at = (element: HTMLElement, value: number) => { element.style.left = `${(100 * share(value, full)).toFixed(1)}%`; return element; };
    this.track.replaceChildren(this.fill, ...bands.map((b) => at(h("div", { class: "tick" }), b)));
    const room = share(bands[bands.length - 1], full) < 0.8; // for the end's number beside the last limit's
    this.numbers.replaceChildren(h("span", {}, "0"), ...bands.map((b) => at(h("span", {}, b.toFixed(0)), b)), ...(room ? [at(h("span", { class: "end" }, full.toFixed(0)), full)] : []));
  }
}

export class BrainPanel {
  readonly element = h("section", { class: "panel brain", "aria-label": "Brain retraction" });
  private readonly pressure = new Bar("Pressure", "mmHg");
  private readonly dose = new Bar("Dose", "mmHg min");
  private readonly rows: HTMLElement[];
  private readonly forms: HTMLElement[];
  private readonly timer = h("output", { class: "brainrow" }, "");
  private readonly seen = h("output", { class: "brainrow" }, "");
  private readonly note = h("p", { class: "note" }, "");
  private readonly modes: HTMLButtonElement[];
  private readonly section: SectionView;
  private readonly hidden = h("p", { class: "note" }, "");
  private readonly shown: HTMLElement[]; // what a blind step or an exam hides

  /// `exam`: blind from beginning to end.
  constructor(scene: Scene, private readonly redraw: () => void, private readonly exam = false) {
    this.section = new SectionView(scene, redraw);
    this.rows = (scene.brain?.blades ?? []).map(() => h("output", { class: "brainrow" }, ""));
    this.forms = (scene.brain?.blades ?? []).map(() => h("output", { class: "brainrow" }, ""));
    this.modes = kModes.map(([mode, label]) => h("button", { class: "segment", onclick: () => this.choose(mode) }, label));
    const stops = kPressureStops.map(([at, colour]) => `${css(colour)} ${((100 * at) / 40).toFixed(0)}%`).join(", ");
    const ramp = h("div", { class: "ramp" });
    ramp.style.background = `linear-gradient(90deg, ${stops})`; // the page forbids style attributes, not properties
    const legend = h("div", { class: "brainlegend", role: "img", "aria-label": "Colours from 0 to 40 mmHg" },
      ramp, h("div", { class: "brainticks" }, ...["0", "10", "20", "30", "40 mmHg"].map((t) => h("span", {}, t))));
    const colours = h("div", { class: "segments", role: "group", "aria-label": "Colours of the pressure" }, ...this.modes);
    this.shown = [this.pressure.element, legend, this.dose.element, ...this.rows, colours, this.section.element];
    setText(this.hidden, exam ? "Exam: pressure and colours are not shown." : "By feel: the pressure is not shown in this step.");
    this.element.append(h("h2", {}, "Retraction"), this.hidden, this.pressure.element, legend, this.dose.element, this.timer, this.seen, ...this.rows, ...this.forms, colours, this.section.element, this.note);
    this.blind(exam); // before the first frame is drawn; another panel may have left it otherwise
    this.choose(pressureView.mode);
  }

  private choose(mode: PressureMode): void {
    pressureView.mode = mode;
    this.modes.forEach((button, k) => button.setAttribute("aria-pressed", String(kModes[k][0] === mode)));
    this.redraw();
  }

  private blind(on: boolean): void {
    pressureView.blind = on;
    this.hidden.hidden = !on;
    for (const one of this.shown) one.hidden = on;
  }

  show(frame: Frame, scene: Scene): void {
    const r = frame.task?.retraction, brain = frame.brain;
    this.blind(this.exam || (r?.blind ?? false));
    this.section.show(frame);
    if (r) {
      pressureView.threshold = r.bands[2];
      this.pressure.show(r.pressure, r.band, r.bands, r.alarm);
      this.dose.show(r.dose, r.dose_band, r.dose_bands, 1.2 * r.dose_bands[2]);
      setText(this.timer, `Without a pause: ${clock(r.loaded)} of the patient's time` + (r.perfusion >= 0 ? ` · perfusion ${r.perfusion.toFixed(0)} mmHg` : ""));
      setText(this.note, `${r.label}. Version ${r.version}. ${r.source}`);
    }
    if (!brain) return;
    setText(this.seen, scene.brain?.target ? `Target seen: ${(100 * brain.exposed).toFixed(0)} %` : "");
    brain.blades.forEach((blade, k) => {
      const forms = scene.brain?.blades[k]?.forms ?? [];
      if (forms.length > 1) setText(this.forms[k], `${forms[blade.form]?.name ?? "blade"}; C off the tissue: ${forms[(blade.form + 1) % forms.length].name}`);
    });
    brain.blades.forEach((blade, k) => setText(this.rows[k], `${scene.brain?.blades[k]?.name ?? "blade"}: ${blade.force.toFixed(2)} N on ${blade.area.toFixed(1)} cm², mean ${blade.mean.toFixed(0)}, tip ${blade.tip.toFixed(0)} mmHg${blade.parked ? (blade.keeps_force ? ", on its arm, which keeps the force" : ", on its arm") : ""}`));
  }
}
