// The needle and the tissue it goes through. Draws what the scene and its frames say.
import * as THREE from "three";
import type { NeedleShape, NeedleState, TissueShape, TissueState } from "../messages";
import type { Materials } from "./materials";

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
  private readonly surface: THREE.Mesh<THREE.BufferGeometry>;
  private readonly holes: THREE.Mesh[] = [];
  private readonly hole = new THREE.SphereGeometry(0.06, 12, 8);
  private readonly dark = new THREE.MeshBasicMaterial({ color: 0x40161a });

  constructor(shape: TissueShape, painted: boolean) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(shape.rest.map((v) => v * kMm)), 3));
    geometry.setIndex(shape.triangles);
    geometry.computeVertexNormals();
    const look = { color: shape.kind === "card" ? 0xe6d3ae : 0xd98f86, side: THREE.DoubleSide, transparent: true, opacity: 0.9 };
    const material = painted
      ? new THREE.MeshLambertMaterial(look)
      : new THREE.MeshPhysicalMaterial({ ...look, roughness: 0.45, clearcoat: shape.kind === "card" ? 0.1 : 0.8, clearcoatRoughness: 0.25 });
    this.surface = new THREE.Mesh(geometry, material);
    this.surface.receiveShadow = this.surface.castShadow = true;
    this.group.add(this.surface);
  }

  update(state: TissueState): void {
    const position = this.surface.geometry.getAttribute("position") as THREE.BufferAttribute;
    const array = position.array as Float32Array, count = Math.min(array.length, state.positions.length);
    for (let i = 0; i < count; ++i) array[i] = state.positions[i] * kMm;
    position.needsUpdate = true;
    this.surface.geometry.computeVertexNormals();
    const at: number[][] = [];
    for (const pass of state.passes) {
      at.push(pass.entry);
      if (pass.exit) at.push(pass.exit);
    }
    while (this.holes.length < at.length) {
      const mesh = new THREE.Mesh(this.hole, this.dark);
      this.holes.push(mesh);
      this.group.add(mesh);
    }
    this.holes.forEach((mesh, k) => {
      mesh.visible = k < at.length;
      if (mesh.visible) mesh.position.set(at[k][0] * kMm, at[k][1] * kMm, at[k][2] * kMm);
    });
  }
}
