import type { Frame, Scene } from "@viewer/messages";
import { blurDiameter, eyeAt, fieldDiameter, magnificationFor, magnificationAtFirst, magnificationShowing, kWorkingDistance, openingAngle, scaleBar, zoomed, type OpticsState } from "@viewer/scene/optics";

const optics = (change: Partial<OpticsState> = {}): OpticsState => ({ magnification: 10, focus: 3, centre: [1, 2], tilt: 0.2, eyeDistance: 22, ...change });

describe("optics", () => {
  it("shows a field of 20 mm at 10x and 5 mm at 40x", () => {
    expect(fieldDiameter(10)).toBeCloseTo(20);
    expect(fieldDiameter(40)).toBeCloseTo(5);
    expect(2 * kWorkingDistance * Math.tan(openingAngle(10) / 2)).toBeCloseTo(20);
  });

  it("zooms by equal ratios within 5x to 40x", () => {
    expect(zoomed(10, 1) / 10).toBeCloseTo(zoomed(20, 1) / 20);
    expect(zoomed(10, 100)).toBe(40);
    expect(zoomed(10, -100)).toBe(5);
    expect(zoomed(zoomed(12, 3), -3)).toBeCloseTo(12);
  });

  it("blurs nothing in focus and more with distance", () => {
    expect(blurDiameter(0)).toBe(0);
    expect(blurDiameter(2)).toBeGreaterThan(blurDiameter(1));
    expect(blurDiameter(-1)).toBeGreaterThan(0);
  });

  it("keeps the eye at the working distance from what is in focus", () => {
    for (const side of [-1, 0, 1] as const) {
      const eye = eyeAt(optics(), side);
      expect(Math.hypot(...eye.position.map((v, k) => v - eye.target[k]))).toBeCloseTo(kWorkingDistance);
    }
  });

  it("makes both eyes agree in the focal plane and look parallel", () => {
    const left = eyeAt(optics(), -1), right = eyeAt(optics(), 1);
    expect(right.position[0] - left.position[0]).toBeCloseTo(22);
    // the centre of the field, seen from a parallel camera, lies off its axis by -base; the shift takes exactly that back
    const field = fieldDiameter(10);
    for (const eye of [left, right]) expect((optics().centre[0] - eye.target[0]) / field).toBeCloseTo(eye.shift);
    const direction = (eye: typeof left) => eye.target.map((v, k) => v - eye.position[k]);
    direction(left).forEach((v, k) => expect(v).toBeCloseTo(direction(right)[k]));
  });

  it("names a round scale bar that fits the field", () => {
    for (const magnification of [5, 7, 10, 16, 25, 40]) {
      const bar = scaleBar(magnification), share = bar / fieldDiameter(magnification);
      expect(share).toBeGreaterThan(0.07);
      expect(share).toBeLessThanOrEqual(0.2 + 1e-9);
      expect([1, 2, 5]).toContain(Math.round(bar / Math.pow(10, Math.floor(Math.log10(bar) + 1e-9))));
    }
  });
});

describe("the start", () => {
  it("shows what is stitched at a third of the field", () => {
    expect(3 * Math.sqrt(5.4 * 1)).toBeCloseTo(fieldDiameter(magnificationFor(5.4, 1)), 9);
    expect(magnificationFor(0.5, 0.5)).toBe(40);
  });

  it("has the needle that is to be taken in the picture", () => {
    const start = magnificationShowing(30.6, 11.4, 1.6); // beside the stumps of anastomosis-8
    expect(fieldDiameter(start) / 2).toBeGreaterThan(13);
    expect(fieldDiameter(start) / 2).toBeLessThan(15);
    expect(magnificationShowing(28, 0.5, 1.6)).toBe(28); // already there
    expect(magnificationShowing(28, 90, 1.6)).toBe(5); // no microscope shows it
  });

  it("has the instruments in the picture that a hand must find, and keeps what shows them already", () => {
    const scene = { tools: [{ kind: "forceps" }, { kind: "needle-holder" }, { kind: "scissors" }] } as unknown as Scene;
    const at = (...tips: number[]) => ({ tools: tips.map((x) => ({ pose: { position: [x, 0, 8e-3] } })) }) as unknown as Frame;
    const start = magnificationAtFirst(8, scene, at(-12e-3, 12e-3, 18e-3), [0, 0]); // knot-square by mouse
    expect(fieldDiameter(start) / 2).toBeGreaterThan(15);
    expect(fieldDiameter(start) / 2).toBeLessThan(18); // scissors may stay outside
    expect(magnificationAtFirst(8, scene, at(-4e-3, 4e-3, 18e-3), [0, 0])).toBe(8);
    expect(magnificationAtFirst(5, { ...scene, brain: {} } as unknown as Scene, at(60e-3), [0, 0])).toBe(5);
    const needle = { ...scene, tissue: {}, needle: { bend_radius: 1.6e-3 } } as unknown as Scene, lies = { ...at(-4e-3, 4e-3), needle: { pose: { position: [0, 11.4e-3, 0] } } } as unknown as Frame;
    expect(magnificationAtFirst(30.6, needle, lies, [0, 0])).toBeCloseTo(magnificationShowing(30.6, 11.4, 1.6), 9);
  });
});
