import { expect, test } from "vitest";
import { needleGeometry } from "../../src/viewer/src/scene/needle";

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
