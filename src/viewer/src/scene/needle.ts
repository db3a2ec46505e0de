// The needle and the tissue it goes through. Draws what the scene and its frames say.
import * as THREE from "three";
import type { Guide, NeedleShape, NeedleState, Overlay, TissueShape, TissueState } from "../messages";
import type { Materials } from "./materials";
import { cividis } from "./palette";
import { fullness, isLiving, sharesAlong, Vessel } from "./vessel";

const kMm = 1000;
const kAlong = 64, kRound = 12; // rings along the wire, corners of a ring

/// Vertices and triangles of the wire in its own frame [mm]: origin at the centre of mass, middle of the arc on +x.
export function needleGeometry(shape: NeedleShape): { vertices: Float32Array; triangles: number[] } {
  const radius = shape.bend_radius * kMm, wire = shape.wire_radius * kMm, half = shape.angle / 2;
  const centre = (radius * Math.sin(half)) / half, length = radius * shape.angle;
  const vertices = new Float32Array(3 * (kAlong + 1) * kRound), triangles: number[] = [];
  for (let i = 0; i <= kAlong; ++i) {
    const arc = (length * i) / kAlong, psi = arc / radius - half;
    const thick = wire * Math.min(1, Math.max(0.03, (length - arc) / (shape.taper * kMm)));
    for (let k = 0; k < kRound; ++k) {
      const turn = (2 * Math.PI * k) / kRound, out = radius + thick * Math.cos(turn);
      vertices.set([out * Math.cos(psi) - centre, out * Math.sin(psi), thick * Math.sin(turn)], 3 * (i * kRound + k));
      if (i === kAlong) continue;
      const a = i * kRound + k, b = i * kRound + ((k + 1) % kRound);
      triangles.push(a, a + kRound, b, b, a + kRound, b + kRound);
    }
  }
  return { vertices, triangles };
}

export class Needle {
  readonly mesh: THREE.Mesh;

  constructor(shape: NeedleShape, materials: Materials) {
    const { vertices, triangles } = needleGeometry(shape);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
    geometry.setIndex(triangles);
    geometry.computeVertexNormals();
    this.mesh = new THREE.Mesh(geometry, materials.bright);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
  }

  update(state: NeedleState): void {
    const [x, y, z] = state.pose.position, [w, i, j, k] = state.pose.quaternion;
    this.mesh.position.set(x * kMm, y * kMm, z * kMm);
    this.mesh.quaternion.set(i, j, k, w);
  }
}

export class Tissue {
  readonly group = new THREE.Group();
  private readonly surface: THREE.Mesh;
  private readonly wet: THREE.Material;
  private readonly plain = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide });
  private readonly holes: THREE.Mesh[] = [];
  private readonly hole = new THREE.SphereGeometry(0.06, 12, 8);
  private readonly dark = new THREE.MeshBasicMaterial({ color: 0x40161a });
  private readonly ring = new THREE.TorusGeometry(0.16, 0.025, 8, 32);
  private readonly bright = new THREE.MeshBasicMaterial({ color: 0xffe27a, depthTest: false, transparent: true });
  private readonly rings: THREE.Mesh[] = [];
  private readonly bridge = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xffe27a, depthTest: false, transparent: true }));
  private places: THREE.Vector3[][] = []; // of each way through the tissue
  private marked: number[] = [];
  private readonly vessel: Vessel | null;
  private readonly own: THREE.Color;
  private shares: Float32Array | null = null; // along the lumen, of each vertex
  private coloured = false; // by a scale

  constructor(private readonly shape: TissueShape, painted: boolean, materials: Materials, floor: number) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(shape.rest.map((v) => v * kMm)), 3));
    geometry.setIndex(shape.triangles);
    geometry.computeVertexNormals();
    const colour = shape.kind === "card" ? 0xe6d3ae : isLiving(shape.name) ? 0xd98f86 : 0xdcc9c0, wet = shape.kind !== "card";
    this.own = new THREE.Color(colour);
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(shape.rest.length), 3));
    const look = { vertexColors: true, side: THREE.DoubleSide, transparent: true, opacity: wet ? 0.82 : 0.9 };
    const material = painted
      ? wet ? new THREE.MeshPhongMaterial({ ...look, shininess: 70, specular: 0x776a66 }) : new THREE.MeshLambertMaterial(look)
      : new THREE.MeshPhysicalMaterial({ ...look, roughness: 0.45, clearcoat: shape.kind === "card" ? 0.1 : 0.8, clearcoatRoughness: 0.25 });
    this.wet = material;
    this.surface = new THREE.Mesh(geometry, material);
    this.surface.receiveShadow = this.surface.castShadow = true;
    this.vessel = shape.clamp_reach > 0 ? new Vessel(shape, materials, colour, painted, floor) : null;
    if (this.vessel) this.group.add(this.vessel.group);
    this.paint(null);
    this.group.add(this.surface, this.bridge);
    this.bridge.visible = false;
    this.bridge.renderOrder = 3;
    this.bridge.frustumCulled = false;
  }

  passes(): THREE.Vector3[][] { return this.places.map((one) => one.map((place) => place.clone())); }

  /// A ring round every hole of these ways through the tissue, and a line from the first to the last: seen through everything.
  mark(passes: number[]): void {
    this.marked = passes;
    this.showMarks();
  }

  private showMarks(): void {
    const at = this.marked.flatMap((pass) => this.places[pass] ?? []);
    while (this.rings.length < at.length) {
      const mesh = new THREE.Mesh(this.ring, this.bright);
      mesh.renderOrder = 3;
      this.rings.push(mesh);
      this.group.add(mesh);
    }
    this.rings.forEach((mesh, k) => { mesh.visible = k < at.length; if (mesh.visible) mesh.position.copy(at[k]); });
    this.bridge.visible = at.length > 1;
    if (at.length < 2) return;
    if (this.bridge.geometry.getAttribute("position")?.count !== at.length) { // a geometry keeps the size it was made with
      this.bridge.geometry.dispose();
      this.bridge.geometry = new THREE.BufferGeometry();
    }
    this.bridge.geometry.setFromPoints(at);
  }

  /// Colours by a number for each vertex, or the tissue's own colour.
  colour(overlay: Overlay | null): void {
    const { geometry } = this.surface;
    this.surface.material = overlay ? this.plain : this.wet; // unlit: the colours are those of the scale
    if (!overlay && this.coloured) this.paint(null);
    this.coloured = overlay !== null;
    if (!overlay) return;
    const colours = geometry.getAttribute("color") as THREE.BufferAttribute;
    const shade = new THREE.Color();
    for (let i = 0; i < Math.min(colours.count, overlay.values.length); ++i) {
      shade.setRGB(...cividis(overlay.values[i] / overlay.full), THREE.SRGBColorSpace);
      colours.setXYZ(i, shade.r, shade.g, shade.b);
    }
    colours.needsUpdate = true;
  }

  /// The tissue's own colour, and that of the blood behind it.
  private paint(blood: TissueState["blood"]): void {
    const colours = this.surface.geometry.getAttribute("color") as THREE.BufferAttribute, shade = new THREE.Color();
    if (blood && !this.shares) this.shares = sharesAlong(this.shape.rest, blood, this.shape.second);
    for (let k = 0; k < colours.count; ++k) {
      shade.copy(this.own);
      if (blood && this.shares) shade.lerp(kInside, 0.7 * fullness(blood, this.shares[k]));
      colours.setXYZ(k, shade.r, shade.g, shade.b);
    }
    colours.needsUpdate = true;
  }

  update(state: TissueState, time: number): void {
    if (state.blood) {
      this.vessel?.update(state, state.blood, time);
      if (!this.coloured) this.paint(state.blood);
    }
    const position = this.surface.geometry.getAttribute("position") as THREE.BufferAttribute;
    const array = position.array as Float32Array, count = Math.min(array.length, state.positions.length);
    for (let i = 0; i < count; ++i) array[i] = state.positions[i] * kMm;
    position.needsUpdate = true;
    this.surface.geometry.computeVertexNormals();
    this.places = state.passes.map((pass) => [pass.entry, ...(pass.exit ? [pass.exit] : [])].map(([x, y, z]) => new THREE.Vector3(x * kMm, y * kMm, z * kMm)));
    const at = this.places.flat();
    this.showMarks();
    while (this.holes.length < at.length) {
      const mesh = new THREE.Mesh(this.hole, this.dark);
      this.holes.push(mesh);
      this.group.add(mesh);
    }
    this.holes.forEach((mesh, k) => {
      mesh.visible = k < at.length;
      if (mesh.visible) mesh.position.copy(at[k]);
    });
  }
}

const kInside = new THREE.Color(0x9a1c1f);
const kGuide = 0x0a3d91, kLift = 0.05; // colour; [mm]

/// Bites and the needle's way for beginners: a ring where it goes in, a square where it comes out, a dotted line for its point.
export class Guides {
  readonly group = new THREE.Group();
  readonly printed: boolean; // marks of the card itself, which are always seen
  private readonly ink = new THREE.LineBasicMaterial({ color: kGuide });
  private readonly way = new THREE.LineDashedMaterial({ color: kGuide, dashSize: 0.08, gapSize: 0.05 });
  private readonly parts: { vertex: number; group: THREE.Group }[] = [];

  constructor(guides: readonly Guide[], private readonly rest: readonly number[]) {
    const { ink, way } = this;
    this.printed = guides.every((guide) => guide.in.path.length === 0);
    const ring = outline(24, 0.1), square = outline(4, 0.12);
    for (const guide of guides) {
      for (const [place, shape] of [[guide.in, ring], [guide.out, square]] as const) {
        const group = new THREE.Group(), mark = new THREE.LineLoop(shape, ink), points: THREE.Vector3[] = [];
        for (let k = 0; k + 2 < place.path.length; k += 3) points.push(new THREE.Vector3(place.path[k] * kMm, place.path[k + 1] * kMm, place.path[k + 2] * kMm));
        mark.position.set(place.at[0] * kMm, place.at[1] * kMm, place.at[2] * kMm);
        const outside = points[shape === ring ? 0 : points.length - 1];
        if (outside) { // lies on the surface, clear of it
          const outward = outside.clone().sub(mark.position).normalize();
          mark.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), outward);
          mark.position.addScaledVector(outward, kLift);
        }
        else mark.position.z += kLift;
        const line = new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), way);
        line.computeLineDistances();
        mark.renderOrder = line.renderOrder = 2;
        group.add(mark, line);
        this.parts.push({ vertex: place.vertex, group });
        this.group.add(group);
      }
    }
  }

  /// Each place moves with its vertex of the tissue; on the colours of a scale the marks are white.
  update(state: TissueState, coloured: boolean): void {
    for (const material of [this.ink, this.way]) material.color.set(coloured ? 0xffffff : kGuide);
    for (const { vertex, group } of this.parts) {
      const k = 3 * vertex;
      if (vertex < 0 || k + 2 >= state.positions.length) continue;
      group.position.set((state.positions[k] - this.rest[k]) * kMm, (state.positions[k + 1] - this.rest[k + 1]) * kMm, (state.positions[k + 2] - this.rest[k + 2]) * kMm);
    }
  }
}

/// Corners of a regular figure in the plane of the background sheet [mm].
function outline(corners: number, radius: number): THREE.BufferGeometry {
  return new THREE.BufferGeometry().setFromPoints(Array.from({ length: corners }, (_, k) => {
    const turn = (2 * Math.PI * (k + 0.5)) / corners;
    return new THREE.Vector3(radius * Math.cos(turn), radius * Math.sin(turn), 0);
  }));
}
