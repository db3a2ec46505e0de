// What belongs to a vessel besides its wall: the double clamp, blood in it and out of its gaps, shreds of adventitia. Everything follows from one frame, so
// that a replay may jump. Millimetres.
import * as THREE from "three";
import type { Blood, TissueShape, TissueState } from "../messages";
import type { Materials } from "./materials";
import { random } from "./textures";

const kMm = 1000;
const kBlood = 0x8c0f14;
const kDrop = 0.38; // [mm3], of a drop that lets go: 0.9 mm across
const kJet = 2.0; // [ml/min], of a sector, from which blood comes as a jet
const kPool = 0.5; // [mm], depth of the pool on the sheet
const kArm = 0.2, kBehind = 0.35; // [mm], an arm's radius, how far it stands behind the held end: as they are touched (world/clamp_bars.h)
const kFull = 20; // [mmHg], from which a stump looks full

export function isLiving(name: string): boolean { return /arter|vein/.test(name); }

/// Volume [mm3] of the drop that hangs at a gap at time `t` [s]: it grows by what comes out and falls when it is full.
export function hanging(rate: number, t: number): number {
  const grown = (rate * 1000 / 60) * t; // [mm3]
  return grown - kDrop * Math.floor(grown / kDrop);
}

export const radiusOf = (volume: number): number => Math.cbrt((3 * volume) / (4 * Math.PI));

/// How full of blood [0 ... 1] the lumen is at this share of its length from the upstream clamp.
export function fullness(blood: Blood, share: number): number {
  const [from, to] = blood.empty;
  if (to > from && share > from && share < to) return 0;
  return Math.min(1, (blood.pressure[share < 0.5 ? 0 : 1] ?? 0) / kFull);
}

/// Where each vertex lies along the lumen, 0 at the upstream clamp, 1 at the downstream one. `second`: the first vertex of a vessel that is sewn to the
/// other's side: its half runs from its edge to its clamp, and the other vessel is all upstream.
export function sharesAlong(rest: readonly number[], blood: Blood, second = 0): Float32Array {
  if (second > 0) return sharesOfSide(rest, blood, second);
  const a = new THREE.Vector3(...blood.clamps[0].position), b = new THREE.Vector3(...blood.clamps[1].position);
  const run = b.clone().sub(a), square = Math.max(1e-12, run.lengthSq()), p = new THREE.Vector3();
  return Float32Array.from({ length: rest.length / 3 }, (_, k) => Math.min(1, Math.max(0, p.fromArray(rest, 3 * k).sub(a).dot(run) / square)));
}

function sharesOfSide(rest: readonly number[], blood: Blood, second: number): Float32Array {
  const end = new THREE.Vector3(...blood.clamps[1].position), p = new THREE.Vector3();
  const away = Float32Array.from({ length: rest.length / 3 }, (_, k) => p.fromArray(rest, 3 * k).distanceTo(end)), furthest = away.subarray(second).reduce((a, b) => Math.max(a, b), 1e-6);
  return away.map((distance, k) => (k < second ? 0 : Math.max(0.5, 1 - (0.5 * distance) / furthest)));
}

class Clamp {
  readonly group = new THREE.Group();
  private readonly jaws = new THREE.Group();
  private readonly beyond: THREE.Mesh;

  constructor(shape: TissueShape, materials: Materials, vessel: THREE.Material) {
    const r = shape.radius * kMm, reach = shape.clamp_reach * kMm;
    for (const side of [-1, 1]) {
      const arm = new THREE.Mesh(new THREE.CapsuleGeometry(kArm, 2 * (reach - kArm), 8, 20), materials.clamp);
      arm.position.set(side * (0.55 * r + kArm), 0, -kBehind);
      this.jaws.add(arm);
    }
    this.beyond = new THREE.Mesh(new THREE.CylinderGeometry(r, 0.85 * r, 7, 24, 1, true), vessel); // the vessel goes on behind its clamp
    this.beyond.rotation.x = Math.PI / 2;
    this.beyond.position.z = -3.5;
    this.group.add(this.jaws, this.beyond);
    this.group.traverse((one) => { one.castShadow = one.receiveShadow = true; });
  }

  update(state: Blood["clamps"][number]): void {
    const [w, x, y, z] = state.quaternion;
    this.group.position.set(...state.position).multiplyScalar(kMm);
    this.group.quaternion.set(x, y, z, w);
    this.jaws.visible = !state.off;
  }
}

/// Fine strands on the outside near the cut, each fast to a vertex and turning with the wall there: its shape is kept in the frame of one triangle of the
/// outer surface, so that it stays outside when the clamp is turned over.
export class Shreds {
  readonly lines: THREE.LineSegments;
  private readonly roots: [number, number, number][] = []; // vertices of the triangle, the one that holds the strand first
  private readonly offsets: THREE.Vector3[] = []; // [mm], of the middle and the tip of each, in its triangle's frame

  constructor(shape: TissueShape) {
    const next = random(7), outer = outerTriangles(shape), middle = middleOf(shape.rest), outward = new THREE.Vector3(), turn = new THREE.Matrix4();
    outer.forEach((triangle, k) => {
      const along = outward.fromArray(shape.rest, 3 * k).sub(middle).y;
      if (Math.abs(along) > 1.1e-3 || next() > 0.75) return;
      outward.setY(0).normalize();
      const away = new THREE.Vector3(0, Math.sign(along), 0), round = new THREE.Vector3().crossVectors(outward, away);
      const strand = (out: number, sideways: number, back: number) => new THREE.Vector3().addScaledVector(outward, out).addScaledVector(round, sideways).addScaledVector(away, back);
      const first = strand(0.03 + 0.06 * next(), (next() - 0.5) * 0.14, 0.1 * next());
      const tip = first.clone().multiplyScalar(1.3).add(strand(0.04 * next(), (next() - 0.5) * 0.16, -0.14 * next()));
      frameAt(shape.rest, triangle, turn).transpose();
      this.roots.push(triangle);
      this.offsets.push(first.applyMatrix4(turn), tip.applyMatrix4(turn));
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(12 * this.roots.length), 3));
    this.lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0xf7e6de, transparent: true, opacity: 0.55 }));
    this.lines.frustumCulled = false;
  }

  update(positions: readonly number[]): void {
    const place = this.lines.geometry.getAttribute("position") as THREE.BufferAttribute, root = new THREE.Vector3(), at = new THREE.Vector3(), turn = new THREE.Matrix4();
    this.roots.forEach((triangle, i) => {
      root.fromArray(positions, 3 * triangle[0]).multiplyScalar(kMm);
      frameAt(positions, triangle, turn);
      place.setXYZ(4 * i, root.x, root.y, root.z);
      at.copy(this.offsets[2 * i]).applyMatrix4(turn).add(root);
      for (const j of [1, 2]) place.setXYZ(4 * i + j, at.x, at.y, at.z);
      at.copy(this.offsets[2 * i + 1]).applyMatrix4(turn).add(root);
      place.setXYZ(4 * i + 3, at.x, at.y, at.z);
    });
    place.needsUpdate = true;
  }
}

function middleOf(rest: readonly number[]): THREE.Vector3 {
  const middle = new THREE.Vector3(), p = new THREE.Vector3();
  for (let k = 0; k < rest.length; k += 3) middle.add(p.fromArray(rest, k));
  return middle.divideScalar(rest.length / 3);
}

/// Of each vertex of the outer surface one triangle that lies in it, the vertex first.
function outerTriangles(shape: TissueShape): Map<number, [number, number, number]> {
  const middle = middleOf(shape.rest), { rest, triangles } = shape, found = new Map<number, [number, number, number]>();
  const outside = (k: number) => Math.hypot(rest[3 * k] - middle.x, rest[3 * k + 2] - middle.z) >= shape.radius - 0.3 * shape.thickness;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.slice(t, t + 3);
    if (![a, b, c].every(outside)) continue;
    for (const one of [[a, b, c], [b, c, a], [c, a, b]] as [number, number, number][]) if (!found.has(one[0])) found.set(one[0], one);
  }
  return found;
}

/// Axes of a triangle: along its first side, across it in its plane, its normal.
function frameAt(positions: readonly number[], [a, b, c]: [number, number, number], into: THREE.Matrix4): THREE.Matrix4 {
  const root = new THREE.Vector3().fromArray(positions, 3 * a), x = new THREE.Vector3().fromArray(positions, 3 * b).sub(root).normalize();
  const z = new THREE.Vector3().fromArray(positions, 3 * c).sub(root).cross(x).negate().normalize();
  return into.makeBasis(x, z.clone().cross(x), z);
}

export class Vessel {
  readonly group = new THREE.Group();
  private readonly clamps: Clamp[];
  private readonly bar: THREE.Mesh;
  private readonly drops: THREE.Mesh[] = [];
  private readonly jets: THREE.Mesh[] = [];
  private readonly pool: THREE.Mesh;
  private readonly shreds: Shreds | null;
  private readonly walls: THREE.MeshLambertMaterial[];

  constructor(shape: TissueShape, materials: Materials, colour: number, painted: boolean, private readonly floor: number) {
    this.walls = (shape.second > 0 ? [0, 1, 2] : [0, 1]).map(() => new THREE.MeshLambertMaterial({ color: colour, side: THREE.DoubleSide }));
    this.clamps = this.walls.map((wall) => new Clamp(shape, materials, wall));
    this.bar = new THREE.Mesh(new THREE.CylinderGeometry(0.22, 0.22, 1, 20), materials.bright);
    const look = { color: kBlood, transparent: true, opacity: 0.93 };
    const blood = painted ? new THREE.MeshPhongMaterial({ ...look, shininess: 90, specular: 0x886666 }) : new THREE.MeshPhysicalMaterial({ ...look, roughness: 0.12, clearcoat: 1 });
    const ball = new THREE.SphereGeometry(1, 20, 14), spray = new THREE.ConeGeometry(0.07, 1, 10).translate(0, 0.5, 0);
    for (let k = 0; k < 8; ++k) {
      this.drops.push(new THREE.Mesh(ball, blood));
      this.jets.push(new THREE.Mesh(spray, blood));
    }
    this.pool = new THREE.Mesh(new THREE.CircleGeometry(1, 64), blood);
    this.shreds = isLiving(shape.name) && shape.second === 0 ? new Shreds(shape) : null;
    this.group.add(...this.clamps.map((one) => one.group), this.bar, ...this.drops, ...this.jets, this.pool);
    if (this.shreds) this.group.add(this.shreds.lines);
    for (const one of [...this.drops, ...this.jets, this.pool]) one.visible = false;
  }

  update(state: TissueState, blood: Blood, time: number): void {
    blood.clamps.forEach((one, k) => this.clamps[k]?.update(one));
    this.placeBar(blood);
    this.walls.forEach((wall, k) => wall.color.set(0xd98f86).lerp(kRed, k === 1 ? 0.75 * fullness(blood, 1) : 0.75));
    const axis = this.axisOf(blood), middle = this.middleOf(blood), at = new THREE.Vector3();
    blood.leak.forEach((rate, k) => {
      const drop = this.drops[k], jet = this.jets[k];
      if (!drop || !jet) return;
      drop.visible = rate > 1e-3;
      jet.visible = rate > kJet;
      if (!drop.visible) return;
      at.fromArray(blood.place, 3 * k).multiplyScalar(kMm);
      const outward = at.clone().sub(middle);
      outward.addScaledVector(axis, -outward.dot(axis)).normalize();
      const radius = rate > kJet ? 0.15 : Math.max(0.03, radiusOf(hanging(rate, time)));
      drop.scale.setScalar(radius);
      drop.position.copy(at).addScaledVector(outward, 0.6 * radius);
      jet.scale.set(1, Math.min(3, 0.6 * Math.sqrt(rate)), 1);
      jet.position.copy(at);
      jet.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), outward);
    });
    this.pool.visible = blood.lost > 0;
    this.pool.position.set(middle.x, middle.y, this.floor + 0.02);
    this.pool.scale.setScalar(Math.max(1e-3, Math.sqrt((1000 * blood.lost) / (Math.PI * kPool))));
    this.shreds?.update(state.positions);
  }

  /// Of the straight line that the cut lies on: the last clamp holds its other end.
  private axisOf(blood: Blood): THREE.Vector3 { return farEnd(blood).sub(new THREE.Vector3(...blood.clamps[0].position)).normalize(); }
  private middleOf(blood: Blood): THREE.Vector3 { return new THREE.Vector3(...blood.clamps[0].position).add(farEnd(blood)).multiplyScalar(0.5 * kMm); }

  /// The bar that joins the clamps of one line, beside the vessel and below it, while both are on.
  private placeBar(blood: Blood): void {
    const ends = [this.clamps[0], this.clamps[this.clamps.length - 1]].map((one) => one.group.localToWorld(new THREE.Vector3(0, 0, -kBehind)));
    const span = ends[1].clone().sub(ends[0]), down = new THREE.Vector3(0, 0, -1.15);
    this.bar.visible = !blood.clamps[0].off && !blood.clamps[blood.clamps.length - 1].off;
    this.bar.position.copy(ends[0]).addScaledVector(span, 0.5).add(down);
    this.bar.scale.set(1, span.length() + 1, 1);
    this.bar.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), span.normalize());
  }
}

const farEnd = (blood: Blood): THREE.Vector3 => new THREE.Vector3(...blood.clamps[blood.clamps.length - 1].position);
const kRed = new THREE.Color(kBlood);
