// Cross-section of the brain: how far the tissue has moved and how hard it is strained, on the plane that the scene names.
// It draws numbers of the frame; the scale is said beside the colours.
import type { Frame, Scene } from "../messages";
import { h, setText } from "./dom";

export type SectionMode = "off" | "displacement" | "stress";
const kModes: [SectionMode, string][] = [["off", "Off"], ["displacement", "Displacement"], ["stress", "Stress"]];
const kScales = [0.2, 0.5, 1, 2, 5, 10, 20, 50]; // full scale, mm or kPa
const kWidth = 320, kMargin = 8;
/// Cividis (Nunez et al., PLoS One 2018): rises in brightness, the same to every colour vision.
const kRamp: [number, number, number][] = [[0, 34, 78], [53, 69, 108], [102, 105, 112], [148, 142, 119], [200, 184, 102], [254, 232, 56]];

/// Colour of a share of the scale.
export function rampColour(share: number): string {
  const at = Math.min(1, Math.max(0, share)) * (kRamp.length - 1), k = Math.min(kRamp.length - 2, Math.floor(at)), s = at - k;
  return `rgb(${kRamp[k].map((c, i) => Math.round(c + s * (kRamp[k + 1][i] - c))).join(" ")})`;
}

/// The smallest full scale that holds `most`.
export function fullScale(most: number): number { return kScales.find((one) => one >= most) ?? kScales[kScales.length - 1]; }

/// Of each triangle: largest displacement of its corners [mm], or stress [kPa].
export function sectionValues(scene: Scene, frame: Frame, mode: SectionMode): number[] {
  const shape = scene.brain?.section, state = frame.brain?.section;
  if (!shape || !state || mode === "off") return [];
  if (mode === "stress") return state.stress;
  const values: number[] = [];
  for (let t = 0; t + 2 < shape.triangles.length; t += 3) {
    let most = 0;
    for (const i of shape.triangles.slice(t, t + 3)) most = Math.max(most, Math.hypot(...[0, 1, 2].map((k) => state.positions[3 * i + k] - shape.rest[3 * i + k])));
    values.push(1000 * most);
  }
  return values;
}

export class SectionView {
  readonly element = h("section", { class: "section", "aria-label": "Cross-section" });
  private readonly canvas = h("canvas", { class: "sectioncanvas", role: "img" });
  private readonly legend = h("output", { class: "brainrow" }, "");
  private readonly modes: HTMLButtonElement[];
  private mode: SectionMode = "off";
  private last: Frame | null = null;

  constructor(private readonly scene: Scene, private readonly redraw: () => void) {
    this.modes = kModes.map(([mode, label]) => h("button", { class: "segment", onclick: () => this.choose(mode) }, label));
    const ramp = h("div", { class: "ramp" });
    ramp.style.background = `linear-gradient(90deg, ${[0, 0.2, 0.4, 0.6, 0.8, 1].map(rampColour).join(", ")})`;
    this.element.append(h("h3", {}, "Cross-section"), h("div", { class: "segments", role: "group", "aria-label": "Cross-section shows" }, ...this.modes), this.canvas, ramp, this.legend);
    this.ramp = ramp;
    this.choose("off");
  }

  private readonly ramp: HTMLElement;

  private choose(mode: SectionMode): void {
    this.mode = mode;
    this.modes.forEach((button, k) => button.setAttribute("aria-pressed", String(kModes[k][0] === mode)));
    for (const one of [this.canvas, this.ramp, this.legend]) one.hidden = mode === "off";
    if (this.last) this.show(this.last); // a replay that rests sends no other
    this.redraw();
  }

  show(frame: Frame): void {
    this.last = frame;
    const values = sectionValues(this.scene, frame, this.mode), shape = this.scene.brain?.section, state = frame.brain?.section;
    if (values.length === 0 || !shape || !state) return;
    const most = values.reduce((a, b) => Math.max(a, b), 0), full = fullScale(most), unit = this.mode === "stress" ? "kPa" : "mm";
    const text = `${this.mode === "stress" ? "Von Mises stress" : "Displacement"} from 0 to ${full} ${unit}; largest ${most.toFixed(2)} ${unit}`;
    setText(this.legend, text);
    this.canvas.setAttribute("aria-label", `Cross-section of the tissue: ${text}`);
    this.draw(state.positions, shape.rest, shape.triangles, values, full, frame);
  }

  private draw(at: number[], rest: number[], triangles: number[], values: number[], full: number, frame: Frame): void {
    let left = Infinity, right = -Infinity, low = Infinity, high = -Infinity;
    for (let i = 0; i < rest.length; i += 3) {
      left = Math.min(left, rest[i + 1]);
      right = Math.max(right, rest[i + 1]);
      low = Math.min(low, rest[i + 2]);
      high = Math.max(high, rest[i + 2]);
    }
    high += 0.15 * (high - low); // room for what swells and for the blades
    const scale = (kWidth - 2 * kMargin) / (right - left), height = Math.round((high - low) * scale + 2 * kMargin);
    if (this.canvas.width !== kWidth || this.canvas.height !== height) { this.canvas.width = kWidth; this.canvas.height = height; }
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const x = (y: number) => kMargin + (y - left) * scale, y = (z: number) => kMargin + (high - z) * scale;
    context.clearRect(0, 0, kWidth, height);
    values.forEach((value, t) => {
      context.beginPath();
      for (let k = 0; k < 3; ++k) context.lineTo(x(at[3 * triangles[3 * t + k] + 1]), y(at[3 * triangles[3 * t + k] + 2]));
      context.closePath();
      context.fillStyle = context.strokeStyle = rampColour(value / full);
      context.fill();
      context.stroke(); // no seams between triangles
    });
    context.strokeStyle = "#ffffff";
    context.lineWidth = 2;
    for (const [a, b] of this.bladeLines(frame, rest[0])) {
      context.beginPath();
      context.moveTo(x(a[1]), y(a[2]));
      context.lineTo(x(b[1]), y(b[2]));
      context.stroke();
    }
    context.lineWidth = 1;
  }

  /// Where the blades cross the plane.
  private bladeLines(frame: Frame, plane: number): [number[], number[]][] {
    const lines: [number[], number[]][] = [];
    (this.scene.brain?.blades ?? []).forEach(({ forms }, k) => {
      const blade = forms[frame.brain?.blades[k]?.form ?? 0];
      const pose = frame.tools[k]?.pose;
      if (!pose) return;
      const [w, qx, qy, qz] = pose.quaternion, place = (i: number): number[] => {
        const v = blade.vertices.slice(3 * i, 3 * i + 3), t = [2 * (qy * v[2] - qz * v[1]), 2 * (qz * v[0] - qx * v[2]), 2 * (qx * v[1] - qy * v[0])];
        return [v[0] + w * t[0] + qy * t[2] - qz * t[1], v[1] + w * t[1] + qz * t[0] - qx * t[2], v[2] + w * t[2] + qx * t[1] - qy * t[0]].map((c, j) => c + pose.position[j]);
      };
      for (let t = 0; t + 2 < blade.triangles.length; t += 3) {
        const corners = blade.triangles.slice(t, t + 3).map(place), cut: number[][] = [];
        for (let c = 0; c < 3; ++c) {
          const a = corners[c], b = corners[(c + 1) % 3];
          if ((a[0] < plane) === (b[0] < plane)) continue;
          const s = (plane - a[0]) / (b[0] - a[0]);
          cut.push(a.map((v, j) => v + s * (b[j] - v)));
        }
        if (cut.length === 2) lines.push([cut[0], cut[1]]);
      }
    });
    return lines;
  }
}
