import * as THREE from "three";
import { describe, expect, it, test, vi } from "vitest";
import type { Blood, TissueShape, TissueState } from "../../src/viewer/src/messages";
import type { Materials } from "../../src/viewer/src/scene/materials";
import { needleGeometry, Tissue } from "../../src/viewer/src/scene/needle";
import { fullness, hanging, radiusOf, sharesAlong, Shreds } from "../../src/viewer/src/scene/vessel";

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

test("the line over marked ways has as many points as there are holes, more or fewer than before", () => {
  const shape = { name: "card", kind: "card", thickness: 1e-4, radius: 0, clamp_reach: 0, second: 0, triangles: [0, 1, 2], rest: [0, 0, 0, 1e-3, 0, 0, 0, 1e-3, 0] } as unknown as TissueShape;
  const tissue = new Tissue(shape, true, {} as Materials, 0), line = tissue.group.children.find((one) => one instanceof THREE.Line) as THREE.Line;
  const pass = (x: number) => ({ entry: [x, 0, 0], exit: [x, 1e-3, 0] });
  tissue.update({ positions: shape.rest, passes: [pass(0), pass(1e-3), pass(2e-3)] } as unknown as TissueState, 0);
  const warn = vi.spyOn(console, "warn").mockImplementation(() => {}), points = () => line.geometry.getAttribute("position");
  for (const [marked, count] of [[[0], 2], [[0, 1, 2], 6], [[2], 2]] as [number[], number][]) {
    tissue.mark(marked);
    expect(points().count).toBe(count);
    expect(points().getX(count - 1)).toBeCloseTo(marked[marked.length - 1], 6);
  }
  tissue.mark([]);
  expect(line.visible).toBe(false);
  expect(warn).not.toHaveBeenCalled();
  warn.mockRestore();
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

describe("shreds of adventitia", () => {
  const round = 24, rings = 9, radius = 0.5e-3, middle = [1e-3, 0, 2e-3];
  /// Two layers of vertices round the axis y, the outer one first; the outer and the inner surface as triangles.
  function tube(): TissueShape {
    const rest: number[] = [], triangles: number[] = [];
    for (const r of [radius, 0.8 * radius])
      for (let j = 0; j < rings; ++j)
        for (let i = 0; i < round; ++i) {
          const angle = (2 * Math.PI * i) / round;
          rest.push(middle[0] + r * Math.cos(angle), (j - (rings - 1) / 2) * 0.2e-3, middle[2] + r * Math.sin(angle));
        }
    for (let layer = 0; layer < 2; ++layer)
      for (let j = 0; j + 1 < rings; ++j)
        for (let i = 0; i < round; ++i) {
          const at = (a: number, b: number) => (layer * rings + b) * round + (a % round), a = at(i, j), b = at(i, j + 1), c = at(i + 1, j), d = at(i + 1, j + 1);
          triangles.push(...(layer === 0 ? [a, b, c, c, b, d] : [a, c, b, c, d, b]));
        }
    return { name: "artery", kind: "vessel", thickness: 0.1e-3, radius, clamp_reach: 1e-3, second: 0, triangles, rest };
  }
  const turned = (rest: readonly number[], angle: number) => rest.map((_, k) => {
    const o = k - (k % 3), x = rest[o] - middle[0], z = rest[o + 2] - middle[2], c = Math.cos(angle), s = Math.sin(angle);
    return [middle[0] + c * x + s * z, rest[o + 1], middle[2] - s * x + c * z][k % 3];
  });
  /// Distances of all points of the strands from the axis [mm].
  const distances = (shreds: Shreds) => {
    const at = shreds.lines.geometry.getAttribute("position");
    return Array.from({ length: at.count }, (_, k) => Math.hypot(at.getX(k) - 1e3 * middle[0], at.getZ(k) - 1e3 * middle[2]));
  };

  it("stay outside the wall however the clamp is turned", () => {
    const shape = tube(), shreds = new Shreds(shape);
    shreds.update(shape.rest);
    const before = distances(shreds);
    expect(before.length).toBeGreaterThan(200);
    for (const angle of [0, Math.PI / 2, Math.PI, 4]) {
      shreds.update(turned(shape.rest, angle));
      distances(shreds).forEach((one, k) => {
        expect(one).toBeCloseTo(before[k], 3);
        if (k % 4 !== 0) expect(one).toBeGreaterThan(1e3 * radius + 0.02);
      });
    }
  });
});
