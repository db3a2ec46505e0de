import * as THREE from "three";
import { kSides, kSubdivisions, ThreadTube } from "@viewer/scene/thread";

const helix = (count: number) => Float64Array.from({ length: 3 * count }, (_, i) => {
  const k = Math.floor(i / 3), a = 0.4 * k;
  return [Math.cos(a), Math.sin(a), 0.05 * k][i % 3];
});

function radii(tube: ThreadTube): number[] {
  const position = tube.mesh.geometry.getAttribute("position").array, out: number[] = [];
  for (let ring = 0; ring < tube.ringCount; ++ring) {
    const centre = [0, 0, 0];
    for (let s = 0; s < kSides; ++s) for (let k = 0; k < 3; ++k) centre[k] += position[3 * (ring * (kSides + 1) + s) + k] / kSides;
    for (let s = 0; s <= kSides; ++s) out.push(Math.hypot(...[0, 1, 2].map((k) => position[3 * (ring * (kSides + 1) + s) + k] - centre[k])));
  }
  return out;
}

describe("thread", () => {
  const material = new THREE.MeshBasicMaterial();

  it("is round everywhere and passes through every node", () => {
    const tube = new ThreadTube(50, material), nodes = helix(30);
    tube.update(nodes, 30, 0.0125);
    expect(tube.ringCount).toBe(29 * kSubdivisions + 1);
    for (const radius of radii(tube)) expect(radius).toBeCloseTo(0.0125, 5);
    const position = tube.mesh.geometry.getAttribute("position").array;
    for (let node = 0; node < 30; ++node) {
      const ring = node * kSubdivisions;
      for (let k = 0; k < 3; ++k) {
        let centre = 0;
        for (let s = 0; s < kSides; ++s) centre += position[3 * (ring * (kSides + 1) + s) + k] / kSides;
        expect(centre).toBeCloseTo(nodes[3 * node + k], 5);
      }
    }
  });

  it("follows a changing number of nodes in the same buffers", () => {
    const tube = new ThreadTube(60, material);
    tube.update(helix(60), 60, 0.01);
    const buffer = tube.mesh.geometry.getAttribute("position").array, full = tube.triangleCount;
    tube.update(helix(20), 20, 0.01);
    expect(tube.mesh.geometry.getAttribute("position").array).toBe(buffer);
    expect(tube.triangleCount).toBe(2 * kSides * 19 * kSubdivisions);
    tube.update(helix(60), 60, 0.01);
    expect(tube.triangleCount).toBe(full);
    expect(tube.mesh.geometry.drawRange.count).toBe(3 * full);
  });

  it("leaves out edges that are cut or broken", () => {
    const tube = new ThreadTube(20, material);
    tube.update(helix(20), 20, 0.01, [5, 12]);
    expect(tube.triangleCount).toBe(2 * kSides * kSubdivisions * (19 - 2));
    const index = tube.mesh.geometry.getIndex()!.array, position = tube.mesh.geometry.getAttribute("position").array;
    let longest = 0;
    for (let t = 0; t < 3 * tube.triangleCount; t += 3) {
      for (const [a, b] of [[0, 1], [1, 2]]) {
        longest = Math.max(longest, Math.hypot(...[0, 1, 2].map((k) => position[3 * index[t + a] + k] - position[3 * index[t + b] + k])));
      }
    }
    expect(longest).toBeLessThan(0.25); // an edge is 0.4 long, a piece of it 0.1: nothing bridges a gap
  });

  it("does not turn over where the thread doubles back", () => {
    const tube = new ThreadTube(10, material);
    tube.update([0, 0, 0, 1, 0, 0, 2, 0.001, 0, 1, 0.1, 0, 0, 0.1, 0], 5, 0.01);
    for (const radius of radii(tube)) expect(Number.isFinite(radius) && radius < 0.0101).toBe(true);
  });

  it("never takes more nodes than it has room for", () => {
    const tube = new ThreadTube(10, material);
    tube.update(helix(40), 40, 0.01);
    expect(tube.ringCount).toBe(9 * kSubdivisions + 1);
  });
});
