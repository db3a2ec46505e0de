// The brain in the field: cortex with its vessels and wet sheen, the pressure of the blades on it in colours, blades,
// bridging veins, the target. It draws what frames say; colours say it a second time beside the panel's words.
import * as THREE from "three";
import type { BrainShape, BrainState, Frame } from "../messages";
import { BladeMask, bladeMaterial, polish } from "./blade_skin";
import { cortexMaterial, cortexUv } from "./cortex_surface";
import { bladeBall, steelBall } from "./materials";

const kMm = 1000;
export type PressureMode = "scale" | "threshold" | "off";
/// How pressure is coloured; chosen in the panel, looked at by every drawing.
export const pressureView: { mode: PressureMode; threshold: number; blind: boolean } = { mode: "scale", threshold: 30, blind: false };

/// Okabe and Ito's colours, told apart with every common colour vision: mmHg and sRGB.
export const kPressureStops: [number, [number, number, number]][] = [
  [3, [0.34, 0.71, 0.91]], [10, [0.94, 0.89, 0.26]], [20, [0.9, 0.62, 0]], [30, [0.84, 0.37, 0]], [40, [0.42, 0.05, 0.42]],
];

/// Colour of a pressure [mmHg] and how much of it covers the tissue, 0 to 1.
export function pressureColour(mmHg: number, mode: PressureMode, threshold: number): { colour: [number, number, number]; cover: number } {
  if (mode === "off" || mmHg <= 0) return { colour: [0, 0, 0], cover: 0 };
  if (mode === "threshold") return { colour: [0.84, 0.2, 0], cover: mmHg >= threshold ? 0.95 : 0 };
  const last = kPressureStops[kPressureStops.length - 1];
  if (mmHg >= last[0]) return { colour: last[1], cover: 0.95 };
  const at = kPressureStops.findIndex(([from]) => mmHg < from);
  if (at === 0) return { colour: kPressureStops[0][1], cover: (0.9 * mmHg) / kPressureStops[0][0] };
  const [from, a] = kPressureStops[at - 1], [to, b] = kPressureStops[at], s = (mmHg - from) / (to - from);
  return { colour: [0, 1, 2].map((k) => a[k] + s * (b[k] - a[k])) as [number, number, number], cover: 0.9 };
}

const kLinear = new THREE.Color();
/// As the renderer counts: linear light.
function linear([r, g, b]: [number, number, number]): [number, number, number] {
  kLinear.setRGB(r, g, b, THREE.SRGBColorSpace);
  return [kLinear.r, kLinear.g, kLinear.b];
}

function mesh(vertices: number[], triangles: number[], material: THREE.Material): THREE.Mesh<THREE.BufferGeometry> {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(vertices.map((v) => v * kMm)), 3));
  geometry.setIndex(triangles);
  geometry.computeVertexNormals();
  const made = new THREE.Mesh(geometry, material);
  made.castShadow = made.receiveShadow = true;
  return made;
}

/// A form of a blade. Tissue that lies on it would shade it in the pattern of its own triangles: no shadow falls on it.
function bladeMesh(form: BrainShape["blades"][number]["forms"][number], steel: THREE.Material): THREE.Mesh {
  const made = mesh(form.vertices, nearTip(form.vertices, form.triangles), steel);
  polish(made.geometry, kShown * kMm);
  made.receiveShadow = false;
  return made;
}

/// Triangles up to kShown from the tip: what is higher would hide the field from an eye straight above, and is out of focus.
const kShown = 0.03; // [m]
function nearTip(vertices: number[], triangles: number[]): number[] {
  const shown: number[] = [];
  for (let t = 0; t + 2 < triangles.length; t += 3) {
    const corners = triangles.slice(t, t + 3);
    if (corners.every((i) => vertices[3 * i + 2] <= kShown)) shown.push(...corners);
  }
  return shown.length > 0 ? shown : triangles;
}

export class Brain {
  readonly group = new THREE.Group();
  private readonly cortex: THREE.Mesh<THREE.BufferGeometry>;
  private readonly blades: THREE.Group[] = []; // each with a mesh for each of its forms
  private readonly arms: RetractorArm[];
  private readonly mask: BladeMask;
  private readonly veins: { mesh: THREE.Mesh; foot: THREE.Mesh; vertex: number; dura: THREE.Vector3 }[];

  constructor(shape: BrainShape, painted: boolean) {
    this.mask = new BladeMask(shape.blades, kShown);
    this.cortex = mesh(shape.rest, shape.triangles, cortexMaterial(painted, this.mask));
    this.cortex.geometry.setAttribute("uv", new THREE.BufferAttribute(cortexUv(shape.rest, this.cortex.geometry.getAttribute("normal").array, kMm), 2));
    this.cortex.geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array((4 * shape.rest.length) / 3), 4));
    this.group.add(this.cortex, rim(shape));
    const ball = painted ? steelBall() : null, polished = bladeMaterial(painted ? bladeBall() : null);
    const steel = ball ? new THREE.MeshMatcapMaterial({ matcap: ball, toneMapped: false }) : new THREE.MeshStandardMaterial({ color: 0xcfd6db, metalness: 1, roughness: 0.3, envMapIntensity: 1.9 });
    for (const blade of shape.blades) {
      const held = new THREE.Group();
      for (const form of blade.forms) held.add(bladeMesh(form, polished));
      this.blades.push(held);
      this.group.add(held);
    }
    this.arms = shape.blades.map((blade, k) => new RetractorArm(shape, blade.forms[0].grip, k, steel));
    for (const arm of this.arms) this.group.add(arm.group);
    if (shape.bone !== null) this.group.add(boneWall(shape));
    if (shape.falx) this.group.add(falxSheet(shape, shape.falx));
    const blue = painted ? new THREE.MeshPhongMaterial({ color: 0x6a3358, specular: 0x665560, shininess: 60 }) : new THREE.MeshPhysicalMaterial({ color: 0x5e2c50, roughness: 0.4, clearcoat: 0.8, clearcoatRoughness: 0.2 });
    this.veins = shape.veins.map(({ vertex, dura }) => {
      const vein = new THREE.Mesh(new THREE.CylinderGeometry(0.6, 0.7, 1, 12), blue), foot = new THREE.Mesh(new THREE.SphereGeometry(0.7, 16, 12), blue);
      this.group.add(vein, foot);
      return { mesh: vein, foot, vertex, dura: new THREE.Vector3(...dura).multiplyScalar(kMm) };
    });
    if (shape.target) {
      const disc = new THREE.Mesh(new THREE.CircleGeometry(shape.target.radius * kMm, 32), new THREE.MeshBasicMaterial({ color: 0x56b4e9, toneMapped: false }));
      disc.position.set(...(shape.target.position as [number, number, number])).multiplyScalar(kMm);
      this.group.add(disc);
    }
  }

  update(frame: Frame): void {
    const state = frame.brain;
    if (!state) return;
    const position = this.cortex.geometry.getAttribute("position") as THREE.BufferAttribute, array = position.array as Float32Array;
    for (let i = 0; i < array.length && i < state.positions.length; ++i) array[i] = state.positions[i] * kMm;
    position.needsUpdate = true;
    this.cortex.geometry.computeVertexNormals();
    this.colour(state);
    this.blades.forEach((blade, k) => {
      const pose = frame.tools[k]?.pose;
      if (!pose) return;
      blade.position.set(pose.position[0], pose.position[1], pose.position[2]).multiplyScalar(kMm);
      blade.quaternion.set(pose.quaternion[1], pose.quaternion[2], pose.quaternion[3], pose.quaternion[0]);
      blade.children.forEach((form, at) => { form.visible = at === (state.blades[k]?.form ?? 0); });
      this.mask.place(k, state.blades[k]?.form ?? 0, blade);
      this.arms[k].update(blade, state.blades[k]?.parked ?? false);
    });
    this.veins.forEach((vein, k) => this.stretch(vein, array, state.veins_torn[k] === 1));
  }

  private colour(state: BrainState): void {
    const colour = this.cortex.geometry.getAttribute("color") as THREE.BufferAttribute, array = colour.array as Float32Array;
    for (let i = 0; i < state.pressure.length && 4 * i + 3 < array.length; ++i) {
      const over = pressureColour(state.pressure[i], pressureView.blind ? "off" : pressureView.mode, pressureView.threshold);
      array.set(linear(over.colour), 4 * i);
      array[4 * i + 3] = over.cover;
    }
    colour.needsUpdate = true;
  }

  private stretch(vein: { mesh: THREE.Mesh; foot: THREE.Mesh; vertex: number; dura: THREE.Vector3 }, at: Float32Array, torn: boolean): void {
    const foot = new THREE.Vector3(at[3 * vein.vertex], at[3 * vein.vertex + 1], at[3 * vein.vertex + 2]);
    const end = torn ? foot.clone().lerp(vein.dura, 0.35) : vein.dura;
    vein.foot.position.copy(foot);
    span(vein.mesh, foot, end);
  }
}

/// The self-retaining arm: a jointed bar from the edge of the window to the blade's shank, there while the blade is held by it.
class RetractorArm {
  readonly group = new THREE.Group();
  private readonly foot: THREE.Vector3;
  private readonly bars: THREE.Mesh[];
  private readonly joints: THREE.Mesh[];

  constructor(shape: BrainShape, private readonly grip: number, blade: number, steel: THREE.Material) {
    const { x, y } = extent(shape);
    this.foot = new THREE.Vector3(0.75 * x * (blade % 2 === 0 ? 1 : -1), -1.05 * y, 5);
    this.bars = [0, 1].map(() => new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 16), steel));
    this.joints = [0, 1].map(() => new THREE.Mesh(new THREE.SphereGeometry(1.5, 20, 14), steel));
    const clamp = new THREE.Mesh(new THREE.BoxGeometry(7, 5, 8), steel);
    clamp.position.copy(this.foot);
    this.group.add(...this.bars, ...this.joints, clamp);
    this.group.visible = false;
  }

  update(blade: THREE.Group, parked: boolean): void {
    this.group.visible = parked;
    if (!parked) return;
    const hold = new THREE.Vector3(0, 0, Math.min(kShown, this.grip) * kMm).applyQuaternion(blade.quaternion).add(blade.position);
    const elbow = this.foot.clone().lerp(hold, 0.5).add(new THREE.Vector3(0, 0, 9));
    span(this.bars[0], this.foot, elbow);
    span(this.bars[1], elbow, hold);
    this.joints[0].position.copy(elbow);
    this.joints[1].position.copy(hold);
  }
}

/// A bar of length one along y put between two points.
function span(bar: THREE.Mesh, from: THREE.Vector3, to: THREE.Vector3): void {
  const way = to.clone().sub(from), length = Math.max(0.1, way.length());
  bar.position.copy(from).addScaledVector(way, 0.5);
  bar.scale.set(1, length, 1);
  bar.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.divideScalar(length));
}

/// Half widths [mm] of the surface.
function extent(shape: BrainShape): { x: number; y: number } {
  let x = 0, y = 0;
  for (let i = 0; i < shape.rest.length; i += 3) {
    x = Math.max(x, Math.abs(shape.rest[i]) * kMm);
    y = Math.max(y, Math.abs(shape.rest[i + 1]) * kMm);
  }
  return { x, y };
}

/// Bone beside an open side of the tissue, such as the orbital roof below a frontal lobe; its face is rough to the eye only.
function boneWall(shape: BrainShape): THREE.Mesh {
  const { x, y } = extent(shape), face = shape.bone! * kMm, depth = Math.min(40, 1.2 * y);
  const wall = new THREE.Mesh(new THREE.BoxGeometry(2 * x, y + face, depth), new THREE.MeshLambertMaterial({ color: 0xdccfb2 }));
  wall.position.set(0, 0.5 * (face - y), -0.5 * depth);
  return wall;
}

/// The falx: a pale fold of dura between the hemispheres.
function falxSheet(shape: BrainShape, falx: NonNullable<BrainShape["falx"]>): THREE.Mesh {
  const { x } = extent(shape), height = (falx.top - falx.bottom) * kMm;
  const sheet = new THREE.Mesh(new THREE.BoxGeometry(2 * x, 0.4, height), new THREE.MeshPhysicalMaterial({ color: 0xe6ddcb, roughness: 0.55, clearcoat: 0.4 }));
  sheet.position.set(0, falx.y * kMm, falx.bottom * kMm + 0.5 * height);
  sheet.castShadow = sheet.receiveShadow = true;
  return sheet;
}

/// The bone about the window: a frame around the block, for the eye only.
function rim(shape: BrainShape): THREE.Mesh {
  const { x: halfX, y: halfY } = extent(shape);
  const outline = new THREE.Shape([[-2, -2], [2, -2], [2, 2], [-2, 2]].map(([x, y]) => new THREE.Vector2(x * halfX, y * halfY)));
  outline.holes.push(new THREE.Path().absellipse(0, 0, halfX * 0.97, halfY * 0.97, 0, 2 * Math.PI, true));
  const bone = new THREE.Mesh(new THREE.ExtrudeGeometry(outline, { depth: 4, bevelEnabled: false, curveSegments: 48 }), new THREE.MeshLambertMaterial({ color: 0xe9dcc0 }));
  bone.position.z = -1;
  return bone;
}
