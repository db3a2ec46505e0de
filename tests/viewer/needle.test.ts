import { describe, expect, it, test } from "vitest";
import type { Blood } from "../../src/viewer/src/messages";
import { needleGeometry } from "../../src/viewer/src/scene/needle";
import { fullness, hanging, radiusOf, sharesAlong } from "../../src/viewer/src/scene/vessel";

test("the drawn wire is the needle of the scene: middle on +x, point on the side of +y, thin at the point", () => {
  const shape = { name: "n", wire_radius: 37.5e-6, bend_radius: 1.6e-3, angle: Math.PI, taper: 0.5e-3 };
  const { vertices, triangles } = needleGeometry(shape);
  const ring = (i: number) => {
    const points = Array.from({ length: 12 }, (_, k) => Array.from(vertices.slice(3 * (12 * i + k), 3 * (12 * i + k) + 3)));
    const middle = [0, 1, 2].map((c) => points.reduce((sum, p) => sum + p[c], 0) / 12);
    return { middle, thick: Math.hypot(...points[0].map((v, c) => v - middle[c])) };
  };
  const swage = ring(0), middle = ring(32), point = ring(64);
  expect(Math.hypot(swage.middle[0] - point.middle[0], swage.middle[1] - point.middle[1])).toBeCloseTo(3.2, 2); // chord of half a circle
  expect(point.middle[1]).toBeGreaterThan(1.5);
  expect(middle.middle[1]).toBeCloseTo(0, 5);
  expect(middle.thick).toBeCloseTo(0.0375, 3);
  expect(point.thick).toBeLessThan(0.01);
  expect(Math.max(...triangles)).toBeLessThan(vertices.length / 3);
});

describe("blood at a gap", () => {
  it("hangs as a drop that grows by what comes out and falls when it is full", () => {
    const rate = 0.06; // [ml/min]: 1 mm3 a second
    expect(hanging(rate, 0.2)).toBeCloseTo(0.2, 9);
    expect(hanging(rate, 0.5)).toBeCloseTo(0.12, 9);
    expect(radiusOf((4 / 3) * Math.PI)).toBeCloseTo(1, 9);
  });

  it("fills a stump with its pressure, but for the stretch that forceps have emptied", () => {
    const at = (y: number) => ({ position: [0, y, 0] as [number, number, number], quaternion: [1, 0, 0, 0] as [number, number, number, number], off: true });
    const blood: Blood = { clamps: [at(-1e-3), at(3e-3)], pressure: [100, 10], leak: [], place: [], through: 0, lost: 0, milking: "stripping", empty: [0.6, 0.8] };
    expect([0.2, 0.55, 0.7, 0.9].map((share) => fullness(blood, share))).toEqual([1, 0.5, 0, 0.5]);
    const shares = sharesAlong([0, -2e-3, 0, 0, 0, 5e-4, 0, 3e-3, 0], blood);
    [0, 0.25, 1].forEach((value, k) => expect(shares[k]).toBeCloseTo(value, 6));
  });
});
