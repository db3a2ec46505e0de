// The instruments as seen: forceps, needle holder and scissors, built from the tool shape that the scene message describes.
// Tool frame: origin at the jaw tip, +z from the tip towards the handle, jaws open along x. Millimetres.
import * as THREE from "three";
import type { ToolShape, ToolState } from "../messages";
import { loft, type Section } from "./loft";
import type { Materials } from "./materials";

const kMm = 1000;
const kReach = 62; // [mm], how far the handle is drawn; it leaves the field long before

export class Instrument {
  readonly group = new THREE.Group();
  private readonly halves: THREE.Object3D[] = [];
  private readonly bending: THREE.Mesh[] = [];
  private readonly maxAngle: number;

  constructor(readonly shape: ToolShape, index: number, metals: Materials) {
    this.maxAngle = Math.max(0.05, shape.max_angle);
    if (shape.kind === "forceps") this.buildForceps(metals);
    else this.buildPivoted(metals, shape.kind === "scissors");
    this.addBands(index, metals);
    this.group.traverse((object) => { object.castShadow = object.receiveShadow = true; });
    this.group.name = shape.name;
  }

  /// Puts the instrument where the frame says it is. No allocation.
  update(state: ToolState): void {
    const { position: p, quaternion: q } = state.pose;
    this.group.position.set(p[0] * kMm, p[1] * kMm, p[2] * kMm);
    this.group.quaternion.set(q[1], q[2], q[3], q[0]);
    const half = Math.max(0, state.grip_angle) / 2;
    for (let i = 0; i < this.halves.length; ++i) this.halves[i].rotation.y = (i === 0 ? -1 : 1) * half;
    for (const mesh of this.bending) mesh.morphTargetInfluences![0] = (2 * half) / this.maxAngle;
  }

  /// Forceps bend at the spring: the half with the jaw is drawn straight and fully open, and anything between is a blend.
  private buildForceps(metals: Materials): void {
    for (const side of [1, -1] as const) {
      const closed = loft(forcepsSections(this.shape, 0), side < 0);
      const open = loft(forcepsSections(this.shape, this.maxAngle / 2), side < 0);
      closed.morphAttributes.position = [open.getAttribute("position")];
      closed.morphAttributes.normal = [open.getAttribute("normal")];
      const mesh = new THREE.Mesh(closed, metals.bright);
      mesh.frustumCulled = false;
      this.bending.push(mesh);
      this.group.add(mesh);
    }
  }

  /// Needle holder and scissors turn rigidly about a pin.
  private buildPivoted(metals: Materials, blades: boolean): void {
    const hinge = this.shape.jaw_length * kMm, radius = this.shape.base_radius * kMm;
    for (const side of [1, -1] as const) {
      const half = new THREE.Group();
      half.position.z = hinge;
      const geometry = loft(pivotedSections(this.shape, blades), side < 0);
      geometry.translate(0, 0, -hinge);
      half.add(new THREE.Mesh(geometry, metals.dark));
      if (!blades) {
        const insert = loft(insertSections(this.shape), side < 0);
        insert.translate(0, 0, -hinge);
        half.add(new THREE.Mesh(insert, metals.grip));
      }
      this.halves.push(half);
      this.group.add(half);
    }
    const lock = new THREE.Mesh(new THREE.CylinderGeometry(1.9 * radius, 1.9 * radius, 2.1 * radius, 40, 1), metals.dark);
    lock.position.z = hinge;
    const screw = new THREE.Mesh(new THREE.SphereGeometry(0.85 * radius, 28, 14, 0, 2 * Math.PI, 0, Math.PI / 2), metals.bright);
    screw.scale.y = 0.45;
    screw.position.set(0, 1.04 * radius, hinge);
    const under = screw.clone();
    under.rotation.x = Math.PI;
    under.position.y = -1.04 * radius;
    this.group.add(lock, screw, under);
  }

  /// One ring on the handle for the first tool, two for the second: told apart without colour.
  private addBands(index: number, metals: Materials): void {
    const z = this.shape.jaw_length * kMm + 4;
    for (let k = 0; k <= index; ++k) {
      for (const side of [1, -1] as const) {
        const sections = (this.shape.kind === "forceps" ? forcepsSections(this.shape, 0) : pivotedSections(this.shape, false));
        const geometry = band(sections, z + 1.5 * k, z + 1.5 * k + 0.8, side < 0);
        const mesh = new THREE.Mesh(geometry, metals.bands[index % metals.bands.length]);
        if (this.halves.length > 0) {
          geometry.translate(0, 0, -this.shape.jaw_length * kMm);
          this.halves[side > 0 ? 0 : 1].add(mesh);
        } else {
          this.group.add(mesh);
        }
      }
    }
  }
}

function interpolate(sections: Section[], z: number): Section {
  let i = 0;
  while (i + 2 < sections.length && sections[i + 1].at[2] < z) ++i;
  const a = sections[i], b = sections[i + 1];
  const t = Math.min(1, Math.max(0, (z - a.at[2]) / (b.at[2] - a.at[2])));
  const mix = (u: number, v: number) => u + t * (v - u);
  return {
    at: [mix(a.at[0], b.at[0]), mix(a.at[1], b.at[1]), z], yaw: mix(a.yaw, b.yaw), width: mix(a.width, b.width),
    height: mix(a.height, b.height), inner: mix(a.inner, b.inner), square: mix(a.square, b.square),
  };
}

function band(sections: Section[], from: number, to: number, mirror: boolean): THREE.BufferGeometry {
  const steps = [from, from + 0.05, (from + to) / 2, to - 0.05, to];
  return loft(steps.map((z, k) => {
    const s = interpolate(sections, z), grow = k === 0 || k === 4 ? 0.01 : 0.06;
    return { ...s, width: s.width + grow, height: s.height + grow, inner: s.inner + grow };
  }), mirror);
}

const smooth = (t: number) => { const c = Math.min(1, Math.max(0, t)); return c * c * (3 - 2 * c); };

/// One half of a pair of jeweller's forceps, opened by `angle` [rad]. A jaw is the round bar that the thread feels (radius from
/// tip_radius to base_radius, the closed pair touching in the middle), flattened a little at the pad.
export function forcepsSections(shape: ToolShape, angle: number): Section[] {
  const jaw = shape.jaw_length * kMm, tip = shape.tip_radius * kMm, base = shape.base_radius * kMm;
  const stations = [0, 0.04, 0.1, 0.2, 0.4, 0.8, 1.4, 2.2, 3.2, 4.4, 5.6, 6.6, 7.4, 8.2, 9, 10, 11.5, 13.5, 16, 19, 23, 28, 34, 41, 50, kReach]
    .map((z) => (z <= 8 ? (z / 8) * jaw : z - 8 + jaw));
  const bendFrom = 0.72 * jaw, bendTo = 1.28 * jaw;
  // centre line: straight handle, bent towards the tip about the hinge
  const centre = new Map<number, [number, number, number]>();
  let x = 0, z = stations[stations.length - 1], previous = z;
  const fine = 0.05;
  const wanted = [...stations].sort((a, b) => b - a);
  for (const station of wanted) {
    while (previous - station > 1e-9) {
      const step = Math.min(fine, previous - station);
      const yaw = angle * (1 - smooth((previous - bendFrom) / (bendTo - bendFrom)));
      x += Math.sin(yaw) * step; z -= Math.cos(yaw) * step; previous -= step;
    }
    centre.set(station, [x, 0, z]);
  }
  const slope = (s: number) => angle * (1 - smooth((s - bendFrom) / (bendTo - bendFrom)));
  return stations.map((s): Section => {
    const u = Math.min(1, s / jaw), past = Math.max(0, s - jaw);
    const nose = Math.sqrt(Math.min(1, Math.max(0.02, 1 - Math.pow(Math.max(0, 1 - s / (0.9 * tip)), 2))));
    const taper = tip + (base - tip) * u;
    const flare = smooth(past / 16), arm = smooth((past - 6) / 30);
    const [cx, , cz] = centre.get(s)!;
    const yaw = -slope(s), beside = taper * (1 - 0.25 * flare) + 0.9 * arm;
    return {
      at: [cx + beside * Math.cos(yaw), 0, cz - beside * Math.sin(yaw)], yaw,
      width: nose * taper * (1 - 0.45 * flare) + 0.2 * arm, height: nose * taper * (1 + 0.9 * flare + 0.7 * arm),
      inner: Math.max(0.3, nose) * taper * (1 - 0.45 * flare), square: 2 + 2.2 * flare,
    };
  });
}

/// One half of a needle holder (or of scissors): the jaw on +x, its handle on the other side of the pin.
export function pivotedSections(shape: ToolShape, blade: boolean): Section[] {
  const jaw = shape.jaw_length * kMm, tip = shape.tip_radius * kMm, base = shape.base_radius * kMm;
  const stations = [0, 0.03, 0.08, 0.18, 0.4, 0.9, 1.6, 2.6, 3.8, 5, 6.2, 7, 7.6, 8, 8.4, 9, 9.8, 11, 12.5, 14.5, 17, 20, 25, 32, 41, 50, kReach]
    .map((z) => (z <= 8 ? (z / 8) * jaw : z - 8 + jaw));
  return stations.map((s): Section => {
    const u = Math.min(1, s / jaw), past = Math.max(0, s - jaw);
    const nose = Math.sqrt(Math.min(1, Math.max(0.02, 1 - Math.pow(Math.max(0, 1 - s / (0.9 * tip)), 2))));
    const taper = tip + (base - tip) * u;
    const cross = smooth((s - 0.9 * jaw) / (0.35 * jaw)), handle = smooth((past - 2) / 14);
    return {
      at: [taper * (1 - cross) - cross * (0.1 + 0.03 * past + 0.9 * handle), 0, s], yaw: 0,
      width: nose * taper * (1 + 0.1 * handle), height: nose * taper * (blade ? 0.75 : 1) * (1 + 0.25 * handle),
      inner: Math.max(0.3, nose) * taper, square: 2 + (blade ? 1.2 : 0.3) * (1 - handle),
    };
  });
}

/// Tungsten carbide insert at the pads.
function insertSections(shape: ToolShape): Section[] {
  const whole = pivotedSections(shape, false), end = 2.2 * shape.pad_length * kMm;
  const from = 0.5 * shape.tip_radius * kMm;
  return [from, from + 0.04, from + 0.15, 0.5 * end, end - 0.1, end].map((z, k) => {
    const s = interpolate(whole, z), share = k === 0 || k === 5 ? 0.9 : 1.025;
    return { ...s, width: s.width * share, height: s.height * share, inner: s.inner * 1.01 };
  });
}
