// Pressure maps of a result: along each blade over time, and on the cortex seen from above. Drawn from what the trainer
// measured; a colour's value is told by the legend and by pointing at it.
import type { PressureMap } from "../messages";
import { kPressureStops, pressureColour } from "../scene/brain";
import { h, setText } from "./dom";
import { clock } from "./format";

type Rgb = [number, number, number];
const kEmpty: Rgb = [0.11, 0.15, 0.16];
const kMapWidth = 900, kBin = 9, kTop = 420;

function css(colour: Rgb): string { return `rgb(${colour.map((c) => Math.round(255 * c)).join(" ")})`; }

/// Colour of a pressure on the map: the live overlay's colours over a dark ground.
export function mapColour(mmHg: number): Rgb {
  const { colour, cover } = pressureColour(mmHg, "scale", 0);
  return kEmpty.map((ground, k) => ground + cover * (colour[k] - ground)) as Rgb;
}

/// Pressure [mmHg] at a place of a blade's picture: shares from the left (time) and from the bottom (tip).
export function pressureAt(map: PressureMap, blade: number, across: number, up: number): { time: number; mm: number; mmHg: number } | null {
  const moments = map.time.length;
  if (moments === 0 || across < 0 || across >= 1 || up < 0 || up >= 1) return null;
  const moment = Math.floor(across * moments), bin = Math.floor(up * map.bins);
  return { time: map.time[moment], mm: (bin + 0.5) * map.bin_mm, mmHg: map.blades[blade].pressure[moment * map.bins + bin] };
}

function bladePicture(map: PressureMap, blade: number, told: HTMLElement): HTMLElement {
  const moments = map.time.length, canvas = h("canvas", { class: "mapcanvas", role: "img" });
  canvas.width = kMapWidth;
  canvas.height = kBin * map.bins;
  let most = 0;
  const context = canvas.getContext("2d");
  const { pressure, name } = map.blades[blade];
  for (let moment = 0; moment < moments; ++moment)
    for (let bin = 0; bin < map.bins; ++bin) {
      const value = pressure[moment * map.bins + bin];
      most = Math.max(most, value);
      if (!context) continue;
      context.fillStyle = css(mapColour(value));
      const from = Math.floor((moment * kMapWidth) / moments);
      context.fillRect(from, canvas.height - kBin * (bin + 1), Math.ceil(kMapWidth / moments) + 1, kBin);
    }
  const end = map.time[moments - 1] ?? 0;
  canvas.setAttribute("aria-label", `${name}: pressure along the blade over ${end.toFixed(0)} s, largest ${most.toFixed(1)} mmHg`);
  canvas.addEventListener("pointermove", (event) => {
    const box = canvas.getBoundingClientRect();
    const found = pressureAt(map, blade, (event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height);
    if (found) setText(told, `${name}, ${clock(found.time)}, ${found.mm.toFixed(0)} mm from the tip: ${found.mmHg.toFixed(1)} mmHg`);
  });
  return h("figure", { class: "bladeovertime" }, h("figcaption", {}, `${name}: largest ${most.toFixed(1)} mmHg`),
    h("div", { class: "mapframe" }, h("div", { class: "mapaxis" }, h("span", {}, `${(map.bins * map.bin_mm).toFixed(0)} mm`), h("span", {}, "tip")), canvas),
    h("div", { class: "maptimes" }, h("span", {}, "0 s"), h("span", {}, `${end.toFixed(0)} s`)));
}

class CortexPicture {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", { class: "cortexmap", role: "img" });
  private readonly caption = h("figcaption", {}, "");
  private readonly buttons: HTMLButtonElement[];

  constructor(private readonly map: PressureMap) {
    this.buttons = (["peak", "dose"] as const).map((what) => h("button", { class: "segment", onclick: () => this.show(what) }, what === "peak" ? "Largest pressure" : "Dose"));
    this.element = h("figure", { class: "oncortex" }, this.caption, h("div", { class: "segments", role: "group", "aria-label": "The cortex shows" }, ...this.buttons), this.canvas);
    this.show("peak");
  }

  private show(what: "peak" | "dose"): void {
    const { map } = this, values = map[what], most = values.reduce((a, b) => Math.max(a, b), 0);
    this.buttons.forEach((button, k) => button.setAttribute("aria-pressed", String((k === 0) === (what === "peak"))));
    const unit = what === "peak" ? "mmHg" : "mmHg min", text = `On the cortex, from above: largest ${most.toFixed(1)} ${unit}`;
    setText(this.caption, what === "peak" ? text : `${text}; purple from ${map.dose_red.toFixed(0)} mmHg min`);
    this.canvas.setAttribute("aria-label", text);
    this.draw((place) => (what === "peak" ? values[place] : (values[place] * 40) / (map.dose_red || 1))); // the red dose in the colour of the alarm
  }

  private draw(value: (place: number) => number): void {
    const { rest, triangles } = this.map, xs = rest.filter((_, i) => i % 3 === 0), ys = rest.filter((_, i) => i % 3 === 1);
    const left = Math.min(...xs), right = Math.max(...xs), low = Math.min(...ys), high = Math.max(...ys), scale = kTop / (right - left || 1);
    this.canvas.width = kTop;
    this.canvas.height = Math.round((high - low) * scale);
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const order = Array.from({ length: triangles.length / 3 }, (_, t) => t), depth = (t: number) => rest[3 * triangles[3 * t] + 2] + rest[3 * triangles[3 * t + 1] + 2] + rest[3 * triangles[3 * t + 2] + 2];
    for (const t of order.sort((a, b) => depth(a) - depth(b))) {
      const corners = triangles.slice(3 * t, 3 * t + 3), mean = corners.reduce((sum, i) => sum + value(i), 0) / 3;
      context.beginPath();
      for (const i of corners) context.lineTo((rest[3 * i] - left) * scale, (high - rest[3 * i + 1]) * scale);
      context.closePath();
      context.fillStyle = css(mapColour(mean));
      context.fill();
      context.strokeStyle = "#ffffff18";
      context.stroke();
    }
  }
}

/// The panel of the result page; null where there was no brain.
export function pressureMapPanel(map: PressureMap | undefined): HTMLElement | null {
  if (!map || map.time.length < 2 || map.blades.length === 0) return null;
  const told = h("output", { class: "quiet", "aria-live": "off" }, "Point at a map to read it.");
  const ramp = h("div", { class: "ramp" });
  ramp.style.background = `linear-gradient(90deg, ${kPressureStops.map(([at, colour]) => `${css(colour)} ${((100 * at) / 40).toFixed(0)}%`).join(", ")})`;
  return h("section", { class: "panel pressuremap" }, h("h2", {}, "Pressure over time"), ...map.blades.map((_, blade) => bladePicture(map, blade, told)), told,
    h("div", { class: "brainlegend", role: "img", "aria-label": "Colours from 0 to 40 mmHg" }, ramp, h("div", { class: "brainticks" }, ...["0", "10", "20", "30", "40 mmHg"].map((t) => h("span", {}, t)))),
    new CortexPicture(map).element);
}
