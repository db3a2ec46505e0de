import * as THREE from "three";
import { Instrument } from "@viewer/scene/instruments";
import type { Materials } from "@viewer/scene/materials";
import type { ToolShape, ToolState } from "@viewer/messages";

const plain = new THREE.MeshBasicMaterial();
const materials: Materials = { bright: plain, clamp: plain, dark: plain, black: plain, grip: plain, bands: [plain, plain, plain], post: plain, sheet: plain, thread: plain };
const shape = (kind: ToolShape["kind"]): ToolShape => ({ name: kind, kind, jaw_length: 8e-3, tip_radius: 0.15e-3, base_radius: 0.6e-3, pad_length: 1.5e-3, max_angle: 0.5 });
const state = (grip_angle: number): ToolState => {
  const pose: ToolState["pose"] = { position: [0, 0, 0], quaternion: [1, 0, 0, 0] };
  return { pose, device_pose: pose, grip_angle, grip_force: 0, thread_force: 0, force: [0, 0, 0], grasped: -1, input_valid: true };
};

/// Points of all faces near the tip, as drawn: morphed and moved into the tool frame.
function tipPoints(instrument: Instrument): THREE.Vector3[] {
  instrument.group.updateMatrixWorld(true);
  const out: THREE.Vector3[] = [];
  instrument.group.traverse((object) => {
    if (!(object instanceof THREE.Mesh)) return;
    const count = object.geometry.getAttribute("position").count;
    for (let i = 0; i < count; ++i) {
      const point = object.getVertexPosition(i, new THREE.Vector3()).applyMatrix4(object.matrixWorld);
      if (point.z < 0.6) out.push(point);
    }
  });
  return out;
}

describe.each(["forceps", "needle-holder", "scissors"] as const)("%s", (kind) => {
  it("closes at the origin of the tool frame and opens along x by the grip angle", () => {
    const instrument = new Instrument(shape(kind), 0, materials);
    instrument.update(state(0));
    const closed = tipPoints(instrument);
    expect(Math.min(...closed.map((p) => p.z))).toBeCloseTo(0, 1);
    expect(Math.max(...closed.filter((p) => p.z < 0.2).map((p) => Math.abs(p.x)))).toBeLessThan(0.36); // two bars of 0.15 mm radius side by side
    for (const angle of [0.2, 0.5]) {
      instrument.update(state(angle));
      const open = tipPoints(instrument);
      const wanted = 8 * Math.sin(angle / 2); // [mm], from the middle to the inner face at the tip
      const inner = Math.min(...open.filter((p) => p.x > 0 && p.z < 0.35).map((p) => p.x));
      expect(inner).toBeGreaterThan(0.8 * wanted - 0.1);
      expect(inner).toBeLessThan(1.05 * wanted + 0.05);
      expect(Math.min(...open.map((p) => p.x))).toBeCloseTo(-Math.max(...open.map((p) => p.x)), 1); // both jaws move alike
    }
  });

  it("has all faces outwards", () => {
    const instrument = new Instrument(shape(kind), 0, materials);
    instrument.group.traverse((object) => {
      if (!(object instanceof THREE.Mesh) || !object.geometry.getIndex()) return;
      const index = object.geometry.getIndex()!, position = object.geometry.getAttribute("position");
      let volume = 0; // of the closed surface; negative if it were inside out
      const [a, b, c] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
      for (let i = 0; i < index.count; i += 3) {
        a.fromBufferAttribute(position, index.getX(i)); b.fromBufferAttribute(position, index.getX(i + 1)); c.fromBufferAttribute(position, index.getX(i + 2));
        volume += a.dot(b.cross(c)) / 6;
      }
      expect(volume).toBeGreaterThan(0);
    });
  });
});

it("the second instrument carries one ring more than the first", () => {
  const count = (index: number) => { let n = 0; new Instrument(shape("forceps"), index, materials).group.traverse((o) => { if (o instanceof THREE.Mesh) ++n; }); return n; };
  expect(count(1)).toBeGreaterThan(count(0));
});
