import { readFileSync } from "node:fs";
import { join } from "node:path";
import * as THREE from "three";
import { describe, expect, it } from "vitest";
import type { Frame, Scene } from "@viewer/messages";
import { Brain, kPressureStops, pressureColour, pressureView } from "@viewer/scene/brain";
import { BladeMask, courseOf } from "@viewer/scene/blade_skin";
import { Bed, cortexUv, vesselTree } from "@viewer/scene/cortex_surface";
import { random } from "@viewer/scene/textures";
import { BrainPanel, share } from "@viewer/ui/brain_panel";
import { mapColour, pressureAt, pressureMapPanel } from "@viewer/ui/pressure_map";
import { fullScale, rampColour, sectionValues } from "@viewer/ui/section_view";
import { frameAt, kScene } from "./sample_frames.mjs";

const shape = {
  name: "block", triangles: [0, 1, 2, 1, 3, 2], rest: [0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0.01, 0.01, 0],
  blades: [{ name: "spatula", forms: [10, 5].map((width) => ({ name: `${width} mm`, vertices: [-0.0005 * width, 0, 0, 0.0005 * width, 0, 0, 0, 0, 0.08], triangles: [0, 1, 2], width: 0.001 * width, grip: 0.1 })) }],
  veins: [{ vertex: 3, dura: [0.02, 0.01, 0.004] as [number, number, number] }], target: null, falx: { y: 0, bottom: -0.02, top: 0.004 }, bone: -0.007, section: { rest: [0, 0, 0, 0, 0.01, 0, 0, 0, -0.01], triangles: [0, 1, 2] }, time_compression: 10,
};
const scene = { ...kScene, brain: shape } as unknown as Scene;
const retraction = { blind: false, pressure: 24, band: "orange", dose: 80, dose_band: "yellow", loaded: 125, perfusion: -1, bands: [10, 20, 30], dose_bands: [75, 150, 225], alarm: 40, label: "Training heuristic, not a clinical limit", version: "1", source: "rats" };
function frame(pressure: number[], torn = 0): Frame {
  const made = frameAt(1, 1, 10);
  return { ...made, task: { ...made.task, retraction }, brain: { positions: shape.rest.map((x, i) => x - (i % 3 === 2 ? 0.002 : 0)), pressure, blades: [{ force: 0.42, area: 1.3, peak: 24, mean: 12, tip: 24, form: 1, parked: true, keeps_force: true }], exposed: 0.5, veins_torn: [torn], section: { positions: [0, 0, -0.003, 0, 0.01, 0, 0, 0, -0.01], stress: [1.4] } } } as unknown as Frame;
}

describe("pressure colours", () => {
  it("leave the tissue alone without pressure and when they are off", () => {
    expect(pressureColour(0, "scale", 30).cover).toBe(0);
    expect(pressureColour(50, "off", 30).cover).toBe(0);
  });
  it("meet their stops and change without a jump between them", () => {
    for (const [at, colour] of kPressureStops) pressureColour(at, "scale", 30).colour.forEach((c, k) => expect(c).toBeCloseTo(colour[k], 6));
    for (let p = 3.1; p < 45; p += 0.1) {
      const a = pressureColour(p, "scale", 30).colour, b = pressureColour(p + 0.1, "scale", 30).colour;
      expect(Math.hypot(...a.map((c, k) => c - b[k]))).toBeLessThan(0.03);
    }
  });
  it("show only what is above the threshold in that mode", () => {
    expect(pressureColour(29.9, "threshold", 30).cover).toBe(0);
    expect(pressureColour(30, "threshold", 30).cover).toBeGreaterThan(0.9);
  });
});

describe("brain", () => {
  it("follows the vertices, colours them and moves the blade with its tool", () => {
    pressureView.mode = "scale";
    const brain = new Brain(shape, true);
    brain.update(frame([0, 0, 40, 0]));
    const cortex = brain.group.children[0] as THREE.Mesh<THREE.BufferGeometry>;
    expect(cortex.geometry.getAttribute("position").getZ(3)).toBeCloseTo(-2, 5);
    const colour = cortex.geometry.getAttribute("color");
    expect(colour.getZ(2)).toBeGreaterThan(colour.getY(2)); // purple at 40 mmHg
    expect(colour.getW(2)).toBeGreaterThan(0.9);
    expect(colour.getW(0)).toBe(0); // tissue elsewhere
  });
  it("draws the form that the blade has", () => {
    const brain = new Brain(shape, true);
    brain.update(frame([0, 0, 0, 0]));
    const held = brain.group.children.find((c) => c instanceof THREE.Group && c.children.length === 2) as THREE.Group;
    expect(held.children.map((form) => form.visible)).toEqual([false, true]);
  });
  it("unrolls the walls of a fissure, so that the picture is not drawn out on them", () => {
    const uv = cortexUv([0, 0.002, -0.001, 0, 0.001, -0.011, 0, -0.002, -0.001, 0, -0.001, -0.011], [0, -1, 0, 0, -1, 0, 0, 1, 0, 0, 1, 0], 1000);
    expect(Math.abs(uv[3] - uv[1]) * 80).toBeCloseTo(11, 4); // 10 mm down and 1 mm across
    expect(Math.abs(uv[7] - uv[5]) * 80).toBeCloseTo(11, 4);
  });
  it("branches its vessels from thick to thin, the same each time", () => {
    const tree = (seed: number) => vesselTree(random(seed), 40, 40, 0, 1, 0.1);
    expect(tree(3)).toEqual(tree(3));
    expect(tree(3).length).toBeGreaterThan(5);
    for (const { widths } of tree(3)) for (let k = 1; k < widths.length; ++k) expect(widths[k]).toBeLessThan(widths[k - 1]);
  });
  it("lets no two vessels of a bed cross", () => {
    const bed = new Bed(), names = { last: 0 }, next = random(11);
    const grown = [0, 1, 2, 3].flatMap((k) => vesselTree(next, 20 + 10 * k, 20, 1.2 + 0.4 * k, 0.6, 0.1, bed, names));
    for (const [i, a] of grown.entries())
      for (let k = 26; k + 1 < a.points.length; k += 2)
        for (const b of grown.slice(i + 1))
          for (let m = 26; m + 1 < b.points.length; m += 2) expect(Math.hypot(a.points[k] - b.points[m], a.points[k + 1] - b.points[m + 1])).toBeGreaterThan(0.05);
  });
  it("shortens a vein that has torn", () => {
    const length = (torn: number) => {
      const brain = new Brain(shape, true);
      brain.update(frame([0, 0, 0, 0], torn));
      return Math.max(...brain.group.children.filter((c) => c instanceof THREE.Mesh).map((c) => (c.geometry instanceof THREE.CylinderGeometry ? c.scale.y : 0)));
    };
    expect(length(1)).toBeLessThan(0.5 * length(0));
  });
});

describe("tissue under a blade", () => {
  // 4 mm rows of a blade that widens over 8 mm and bends beyond 20 mm
  const rows = Array.from({ length: 11 }, (_, i) => ({ half: Math.min(0.005, 0.003 + 0.00025 * 4 * i), y: i > 5 ? 0.002 * (i - 5) : 0, z: 0.004 * i }));
  const form = { name: "bent", vertices: rows.flatMap(({ half, y, z }) => [-half, y, z, 0, y, z, half, y, z]), triangles: [], width: 0.01, grip: 0.1 };
  it("knows the blade's course by where it bends or widens, as far as it is drawn", () => {
    expect(courseOf(form, 0.03).map((row) => row.toArray().map((x) => Math.round(x * 1e3) / 1e3))).toEqual([[0, 0, 3], [0, 8, 5], [0, 20, 5], [4, 28, 5]]);
  });
  it("hands the course and the place of each blade to the tissue's shader", () => {
    const mask = new BladeMask([{ name: "one", forms: [form] }], 0.03), blade = new THREE.Object3D(), shader = { uniforms: {} as Record<string, { value: unknown }>, vertexShader: "#include <begin_vertex>", fragmentShader: "#include <clipping_planes_fragment>" };
    blade.position.set(1, 2, 3);
    mask.place(0, 0, blade);
    mask.place(1, 0, blade); // there is no second blade
    mask.install(shader as unknown as THREE.WebGLProgramParametersWithUniforms);
    expect(shader.uniforms.bladeCount.value).toEqual([4, 0]);
    expect(new THREE.Vector3(1, 2, 3).applyMatrix4((shader.uniforms.bladeFrom.value as THREE.Matrix4[])[0]).length()).toBeLessThan(1e-12);
    expect(shader.fragmentShader).toContain("if (underBlade()) discard;");
  });
});

describe("brain panel", () => {
  it("says pressure, dose and the limits' label in words, not by colour alone", () => {
    const panel = new BrainPanel(scene, () => {});
    panel.show(frame([0, 0, 0, 0]), scene);
    const text = panel.element.textContent ?? "";
    expect(text).toContain("24.0 mmHg · high");
    expect(text).toContain("80.0 mmHg min · watch");
    expect(text).toContain("Training heuristic, not a clinical limit");
    expect(text).toContain("0.42 N");
    expect(text).toContain("on its arm");
    expect(text).toContain("5 mm; C off the tissue: 10 mm");
    expect(text).toContain("40 mmHg");
  });
  it("marks the limits of the bands where they stand on the bar, whose end is the alarm", () => {
    const panel = new BrainPanel(scene, () => {});
    panel.show(frame([0, 0, 0, 0]), scene);
    const [meter, dose] = [...panel.element.querySelectorAll(".brainmeter")];
    expect([...meter.querySelectorAll<HTMLElement>(".tick")].map((one) => one.style.left)).toEqual(["25.0%", "50.0%", "75.0%"]);
    expect([...meter.querySelectorAll<HTMLElement>(".scale span")].map((one) => one.textContent)).toEqual(["0", "10", "20", "30", "40"]);
    expect([...dose.querySelectorAll(".scale span")].map((one) => one.textContent)).toEqual(["0", "75", "150", "225"]); // no room for its end
  });
  it("bars never run over", () => {
    expect(share(50, 40)).toBe(1);
    expect(share(-1, 40)).toBe(0);
    expect(share(1, 0)).toBe(0);
  });
  it("has a look with colour and pattern for every band above fine", () => {
    const style = readFileSync(join(__dirname, "../../src/viewer/src/style.css"), "utf8");
    const fills = ["yellow", "orange", "red"].map((band) => new RegExp(`\\[data-band=${band}\\] \\.fill \\{ background: (repeating[^;]*);`).exec(style)?.[1]);
    expect(new Set(fills).size).toBe(3);
    expect(fills.every(Boolean)).toBe(true);
  });
  it("switches the colours", () => {
    let drawn = 0;
    const panel = new BrainPanel(scene, () => { ++drawn; });
    const off = [...panel.element.querySelectorAll("button")].find((b) => b.textContent === "Off")!;
    off.click();
    expect(pressureView.mode).toBe("off");
    expect(off.getAttribute("aria-pressed")).toBe("true");
    expect(drawn).toBeGreaterThan(1);
    pressureView.mode = "scale";
  });
});

describe("cross-section", () => {
  it("shows the displacement of its corners in mm and the stress as it comes", () => {
    expect(sectionValues(scene, frame([]), "displacement")[0]).toBeCloseTo(3, 6);
    expect(sectionValues(scene, frame([]), "stress")).toEqual([1.4]);
    expect(sectionValues(scene, frame([]), "off")).toEqual([]);
    expect(fullScale(1.4)).toBe(2);
    expect(fullScale(1e9)).toBe(50);
    expect(rampColour(-1)).toBe("rgb(0 34 78)");
    expect(rampColour(2)).toBe("rgb(254 232 56)");
  });
  it("says its scale in words", () => {
    const panel = new BrainPanel(scene, () => {});
    [...panel.element.querySelectorAll("button")].find((b) => b.textContent === "Stress")!.click();
    panel.show(frame([0, 0, 0, 0]), scene);
    expect(panel.element.textContent).toContain("Von Mises stress from 0 to 2 kPa; largest 1.40 kPa");
  });
});

describe("a blind step", () => {
  it("shows no pressure, neither in words nor on the tissue, and shows it again afterwards", () => {
    const panel = new BrainPanel(scene, () => {}), seen = frame([40, 40, 40, 40]), blind = { ...seen, task: { ...seen.task, retraction: { ...retraction, blind: true } } } as unknown as Frame;
    panel.show(blind, scene);
    const meters = [...panel.element.querySelectorAll<HTMLElement>(".brainmeter")];
    expect(meters.every((meter) => meter.hidden)).toBe(true);
    const brain = new Brain(shape, true);
    brain.update(blind);
    const colour = (brain.group.children[0] as THREE.Mesh<THREE.BufferGeometry>).geometry.getAttribute("color");
    expect([0, 1, 2, 3].map((i) => colour.getW(i))).toEqual([0, 0, 0, 0]);
    panel.show(seen, scene);
    expect(meters.some((meter) => meter.hidden)).toBe(false);
    expect(pressureView.blind).toBe(false);
  });
});

describe("an exam", () => {
  const colours = (seen: Frame): number[] => {
    const brain = new Brain(shape, true);
    brain.update(seen);
    const colour = (brain.group.children[0] as THREE.Mesh<THREE.BufferGeometry>).geometry.getAttribute("color");
    return [0, 1, 2, 3].map((i) => colour.getW(i));
  };
  const visible = (panel: BrainPanel, what: string) => [...panel.element.querySelectorAll<HTMLElement>(what)].filter((one) => !one.closest("[hidden]"));

  it("hides pressure, colours, legend, cross-section and their buttons from the first frame on", () => {
    const panel = new BrainPanel(scene, () => {}, true), seen = frame([40, 40, 40, 40]);
    for (const when of ["before", "after"]) {
      expect(visible(panel, "button, .brainmeter, .brainlegend, .section"), when).toEqual([]);
      expect(colours(seen), when).toEqual([0, 0, 0, 0]);
      panel.show(seen, scene);
    }
    expect(visible(panel, "output, p").map((one) => one.textContent).join()).not.toMatch(/24\.0|0\.42 N/);
    expect(panel.element.textContent).toContain("Exam: pressure and colours are not shown.");
  });
  it("leaves nothing hidden in the next task, nor shown in a task after it", () => {
    const seen = frame([40, 40, 40, 40]);
    new BrainPanel(scene, () => {}, true);
    const next = new BrainPanel(scene, () => {});
    expect(colours(seen)[0]).toBeGreaterThan(0.9);
    expect(visible(next, "button").length).toBeGreaterThan(3);
    const again = new BrainPanel(scene, () => {}, true);
    expect(visible(again, "button")).toEqual([]);
    pressureView.blind = false;
  });
});

describe("retractor's arm", () => {
  it("is there while the blade is held by it", () => {
    const brain = new Brain(shape, true), arms = () => brain.group.children.filter((c) => c instanceof THREE.Group && c.children.length === 5);
    brain.update(frame([0, 0, 0, 0]));
    expect(arms()).toHaveLength(1);
    expect(arms()[0].visible).toBe(true);
    const free = frame([0, 0, 0, 0]);
    free.brain!.blades[0].parked = false;
    brain.update(free);
    expect(arms()[0].visible).toBe(false);
  });
});

describe("pressure map", () => {
  const map = { time: [0, 1, 2], bins: 2, bin_mm: 4, blades: [{ name: "spatula", pressure: [0, 0, 12, 3, 40, 5] }], rest: shape.rest.map((x) => 1000 * x), triangles: shape.triangles, peak: [0, 10, 40, 0], dose: [0, 0, 30, 0], dose_red: 225 };
  it("is read where one points", () => {
    expect(pressureAt(map, 0, 0.5, 0.25)).toEqual({ time: 1, mm: 2, mmHg: 12 });
    expect(pressureAt(map, 0, 0.99, 0.75)).toEqual({ time: 2, mm: 6, mmHg: 5 });
    expect(pressureAt(map, 0, 1, 0.5)).toBeNull();
    expect(mapColour(0)).not.toEqual(mapColour(20));
  });
  it("says its largest pressure, and is left out where there was no brain", () => {
    expect(pressureMapPanel(map)!.textContent).toContain("spatula: largest 40.0 mmHg");
    expect(pressureMapPanel(undefined)).toBeNull();
  });
});
