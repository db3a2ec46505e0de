// The round field of the microscope on the page: canvas, reticle, drawing loop, and the controls of the optics.
import type { Frame, Scene } from "../messages";
import { clampMagnification, fieldDiameter, scaleBar, zoomed } from "../scene/optics";
import { Microscope, type StereoMode } from "../scene/microscope";
import { h, setText, svg } from "./dom";

const kFocusStep = 0.1; // [mm]
const kReticleSize = 1000; // units of the drawing

export class FieldView {
  readonly element: HTMLDivElement;
  readonly surface: HTMLDivElement;
  readonly microscope: Microscope;
  ondrawn: (ids: number[], frame: Frame) => void = () => {};
  onoptics: () => void = () => {};
  onclick: (event: MouseEvent) => void = () => {}; // not after a drag
  private readonly canvas = h("canvas", { "aria-hidden": "true" });
  private readonly reticles: SVGElement[] = [];
  private readonly lenses = h("div", { class: "lenses" });
  private frame: Frame | null = null;
  private readonly waiting: number[] = [];
  private dirty = true;
  private running = false;
  private lastTick = 0;
  private drewLast = false;
  private reticleOn = true;
  private guidesOn = false;

  constructor() {
    this.surface = h("div", { class: "surface", tabindex: 0, role: "application", "aria-label": "View through the microscope. Press question mark for the keys, Escape to leave." },
      this.canvas, this.lenses);
    this.element = h("div", { class: "field" }, this.surface);
    this.microscope = new Microscope(this.canvas);
    for (let k = 0; k < 2; ++k) {
      const reticle = svg(`<svg class="reticle" viewBox="-500 -500 ${kReticleSize} ${kReticleSize}" aria-hidden="true"></svg>`);
      this.reticles.push(reticle);
      this.lenses.append(h("div", { class: "lens" }, reticle));
    }
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => { this.dirty = true; });
    let pressed = [0, 0];
    this.surface.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
    this.surface.addEventListener("click", (event) => { if (Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4) this.onclick(event); });
    new ResizeObserver(() => this.fit()).observe(this.element);
    this.drawReticle();
  }

  describe(scene: Scene): void {
    this.answer(); // the trainer sends no more than two frames that nobody has answered
    this.frame = null;
    this.microscope.describe(scene);
    this.changed();
  }

  show(frame: Frame): void {
    this.frame = frame;
    this.waiting.push(frame.id);
    this.dirty = true;
  }

  /// Frames of a lost connection need no answer any more.
  newLine(): void { this.waiting.length = 0; }

  start(): void {
    if (this.running) return;
    this.running = true;
    this.drewLast = false;
    this.fit();
    requestAnimationFrame(this.tick);
  }

  stop(): void { this.running = false; }

  get latest(): Frame | null { return this.frame; }
  get metresPerPixel(): number { return this.microscope.millimetresPerPixel / 1000; }

  zoom(steps: number): void { this.setMagnification(zoomed(this.microscope.optics.magnification, steps)); }
  setMagnification(value: number): void { this.microscope.optics.magnification = clampMagnification(value); this.changed(); }
  focus(steps: number): void { this.setFocus(this.microscope.optics.focus + steps * kFocusStep); }
  /// [mm] above the background sheet the focal plane may stand at most 25 and 5 below.
  setFocus(height: number): void {
    const floor = this.microscope.stage.floorHeight;
    this.microscope.optics.focus = Math.min(floor + 25, Math.max(floor - 5, height));
    this.changed();
  }
  focusOnTool(index: number): void {
    const tool = this.frame?.tools[index];
    if (tool) this.setFocus(tool.pose.position[2] * 1000);
  }
  setEyeDistance(millimetres: number): void { this.microscope.optics.eyeDistance = Math.min(40, Math.max(4, millimetres)); this.changed(); }
  setStereo(mode: StereoMode): void { this.microscope.stereo = mode; this.fit(); this.changed(); }
  pan(dxMm: number, dyMm: number): void {
    const { optics } = this.microscope;
    optics.centre = [Math.min(20, Math.max(-20, optics.centre[0] + dxMm)), Math.min(20, Math.max(-20, optics.centre[1] + dyMm))];
    this.changed();
  }
  toggleReticle(): void { this.reticleOn = !this.reticleOn; this.changed(); }
  get reticleShown(): boolean { return this.reticleOn; }
  reset(): void {
    const { optics } = this.microscope;
    Object.assign(optics, { magnification: this.microscope.startMagnification, focus: this.microscope.stage.focusHeight, centre: [...this.microscope.stage.centre], eyeDistance: 22 });
    this.changed();
  }
  /// Ways through the tissue to be marked.
  showGuides(on: boolean): void { this.guidesOn = on; this.microscope.stage.showGuides(on); this.changed(); }
  get guidesShown(): boolean { return this.guidesOn; }
  mark(passes: number[]): void { this.microscope.stage.mark(passes); this.changed(); }
  /// The way through the tissue that is nearest to a point of the page, -1: none is near.
  passAt(clientX: number, clientY: number): number {
    const box = this.canvas.getBoundingClientRect();
    return this.microscope.passAt((2 * (clientX - box.left)) / box.width - 1, 1 - (2 * (clientY - box.top)) / box.height);
  }
  /// Puts the field over these ways through the tissue; the middle of the scene where there are none.
  look(passes: number[], magnification: number): void {
    const { optics, stage } = this.microscope, known = stage.passes(), places = passes.flatMap((pass) => known[pass] ?? []);
    optics.magnification = clampMagnification(magnification);
    optics.centre = [...stage.centre];
    optics.focus = stage.focusHeight;
    for (const [c, axis] of (["x", "y"] as const).entries()) if (places.length > 0) optics.centre[c] = places.reduce((sum, place) => sum + place[axis], 0) / places.length;
    if (places.length > 0) optics.focus = places.reduce((sum, place) => sum + place.z, 0) / places.length;
    this.changed();
  }
  /// The newest frame as it is seen now, a JPEG in an address.
  picture(): string {
    if (this.frame) this.take(this.frame);
    this.microscope.draw();
    return this.canvas.toDataURL("image/jpeg", 0.85);
  }
  /// Quality was chosen by hand.
  redraw(): void { this.changed(); }

  /// The first frame may show that the start's magnification leaves the needle out of the picture; scale bar and sliders follow.
  private take(frame: Frame): void {
    const { magnification } = this.microscope.optics;
    this.microscope.update(frame);
    if (this.microscope.optics.magnification !== magnification) this.changed();
  }

  private changed(): void {
    this.dirty = true;
    this.drawReticle();
    this.onoptics();
  }

  private readonly tick = (now: number): void => {
    if (!this.running) return;
    requestAnimationFrame(this.tick);
    const interval = now - this.lastTick;
    this.lastTick = now;
    const { quality } = this.microscope;
    if (this.drewLast) {
      this.microscope.lastFrameTime += 0.1 * (interval - this.microscope.lastFrameTime);
      if (quality.measured(interval)) this.changed();
    }
    this.drewLast = this.dirty;
    if (!this.dirty) return;
    this.dirty = false;
    if (this.frame) this.take(this.frame);
    this.microscope.draw();
    this.answer();
  };

  private answer(): void {
    if (this.frame && this.waiting.length > 0) this.ondrawn(this.waiting, this.frame);
    this.waiting.length = 0;
  }

  private fit(): void {
    const box = this.element.getBoundingClientRect();
    if (box.width === 0 || box.height === 0) return;
    const columns = this.microscope.stereo === "side-by-side" ? 2 : 1;
    const diameter = Math.floor(Math.min(box.width / columns, box.height));
    this.microscope.resize(diameter);
    this.surface.style.width = `${diameter * columns}px`;
    this.surface.style.height = `${diameter}px`;
    this.element.dataset.stereo = this.microscope.stereo;
    this.dirty = true;
  }

  /// Cross with millimetre marks and a scale bar of a round length.
  private drawReticle(): void {
    const { magnification } = this.microscope.optics;
    const perMm = kReticleSize / fieldDiameter(magnification);
    const bar = scaleBar(magnification);
    const step = bar >= 2 ? 1 : bar >= 0.5 ? 0.5 : 0.1;
    const marks: string[] = [];
    for (let k = 1; k * step * perMm < 330; ++k) {
      const at = k * step * perMm, long = k % 5 === 0 ? 16 : 8;
      for (const s of [-1, 1]) marks.push(`M${s * at} ${-long}V${long}M${-long} ${s * at}H${long}`);
    }
    const half = (bar * perMm) / 2;
    const text = bar >= 1 ? `${bar} mm` : `${bar.toFixed(1)} mm`;
    for (const reticle of this.reticles) {
      reticle.style.display = this.reticleOn ? "" : "none";
      reticle.innerHTML = `<g fill="none"><path d="M-340 0H-36M36 0H340M0 -340V-36M0 36V340${marks.join("")}" class="ink"/><circle r="5" class="ink"/></g>
        <path d="M${-half} 398v12h${2 * half}v-12" fill="none" class="ink bar"/><text y="388" text-anchor="middle">${text}</text>
        <text y="-415" text-anchor="middle" class="mag">${magnification.toFixed(1)}×</text>`;
    }
  }
}

const kModes: [StereoMode, string, string][] = [["mono", "One eye", "1"], ["side-by-side", "Side by side", "2"], ["anaglyph", "Red-cyan", "3"]];

/// Sliders and buttons of the optics; follows the view when keys change it.
export function opticsBar(view: FieldView): HTMLElement {
  const slider = (label: string, min: number, max: number, step: number, set: (value: number) => void, key: string) => {
    const input = h("input", { type: "range", min, max, step, "aria-label": label, oninput: () => set(Number(input.value)) });
    const value = h("output", {}, "");
    return { input, value, row: h("label", { class: "optic", title: `${label} (${key})` }, h("span", {}, label), input, value) };
  };
  const zoom = slider("Magnification", Math.log(5), Math.log(40), 0.01, (v) => view.setMagnification(Math.exp(v)), "+ −");
  const focus = slider("Focus", 0, 1, 0.001, (v) => view.setFocus(view.microscope.stage.floorHeight - 5 + 30 * v), "[ ]");
  const eyes = slider("Eye distance", 4, 40, 1, (v) => view.setEyeDistance(v), ", .");
  const modes = kModes.map(([mode, label, key]) => h("button", { class: "segment", title: `${label} (${key})`, onclick: () => view.setStereo(mode) }, label));
  const reticle = h("button", { class: "segment", title: "Reticle (G)", onclick: () => view.toggleReticle() }, "Reticle");
  const quality = h("select", { "aria-label": "Picture quality", onchange: () => { view.microscope.quality.choose(quality.value as "auto"); view.redraw(); } },
    ...["auto", "high", "medium", "low", "software"].map((name) => h("option", { value: name }, name === "software" ? "lowest" : name)));
  const rate = h("output", { class: "rate", title: view.microscope.rendererName }, "");
  const element = h("div", { class: "optics", role: "group", "aria-label": "Microscope" }, zoom.row, focus.row, eyes.row,
    h("div", { class: "segments", role: "group", "aria-label": "Stereo" }, ...modes), reticle,
    h("label", { class: "optic" }, h("span", {}, "Quality"), quality, rate));
  const follow = () => {
    const { optics, stage, stereo, quality: chooser } = view.microscope;
    zoom.input.value = String(Math.log(optics.magnification));
    setText(zoom.value, `${optics.magnification.toFixed(1)}×`);
    focus.input.value = String((optics.focus - stage.floorHeight + 5) / 30);
    setText(focus.value, `${(optics.focus - stage.floorHeight).toFixed(1)} mm`);
    eyes.input.value = String(optics.eyeDistance);
    setText(eyes.value, `${optics.eyeDistance.toFixed(0)} mm`);
    eyes.row.classList.toggle("off", stereo === "mono");
    modes.forEach((button, k) => button.setAttribute("aria-pressed", String(kModes[k][0] === stereo)));
    reticle.setAttribute("aria-pressed", String(view.reticleShown));
    const names: Record<string, string> = { software: "lowest", low: "low", medium: "medium", high: "high" };
    setText(rate, chooser.automatic ? `${names[chooser.current.name]}${chooser.software ? ", no graphics chip" : ""}` : "");
  };
  view.onoptics = follow;
  follow();
  return element;
}
