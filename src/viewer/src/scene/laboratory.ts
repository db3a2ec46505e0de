// What the laboratory's tasks add to the field: the target of the present step and the objects to be moved.
import * as THREE from "three";
import type { Frame, Scene } from "../messages";
import type { Materials } from "./materials";

const kMm = 1000;
const kTarget = new THREE.MeshBasicMaterial({ color: 0xf0a52e, transparent: true, opacity: 0.85, toneMapped: false });

export class Laboratory {
  readonly group = new THREE.Group();
  private readonly objects: THREE.Mesh[];
  private readonly target = new THREE.Group();
  private shown = "";

  constructor(scene: Scene, materials: Materials) {
    this.objects = (scene.objects ?? []).map((object) => {
      const mesh = new THREE.Mesh(new THREE.SphereGeometry(object.radius * kMm, 32, 24), materials.post);
      mesh.castShadow = mesh.receiveShadow = true;
      return mesh;
    });
    this.group.add(...this.objects, this.target);
  }

  update(frame: Frame): void {
    const rows = frame.objects ?? [];
    this.objects.forEach((mesh, k) => {
      mesh.visible = rows.length >= 4 * k + 4;
      if (!mesh.visible) return;
      mesh.position.set(rows[4 * k], rows[4 * k + 1], rows[4 * k + 2]).multiplyScalar(kMm);
      mesh.scale.z = rows[4 * k + 3] > 0 ? 0.35 : 1; // broken: collapsed
    });
    this.show(frame.task?.target ?? [], frame.task?.within ?? 0);
  }

  /// Built anew only when the target changes: once a step.
  private show(points: number[], within: number): void {
    const key = `${within}:${points.join()}`;
    if (key === this.shown) return;
    this.shown = key;
    for (const part of this.target.children) if (part instanceof THREE.Mesh) part.geometry.dispose();
    this.target.clear();
    const at: THREE.Vector3[] = [];
    for (let i = 0; i + 2 < points.length; i += 3) at.push(new THREE.Vector3(points[i], points[i + 1], points[i + 2]).multiplyScalar(kMm));
    if (at.length === 1) this.target.add(ring(at[0], within * kMm), dot(at[0], 0.06));
    for (let i = 1; i < at.length; ++i) this.target.add(line(at[i - 1], at[i]));
    if (at.length > 1) this.target.add(dot(at[0], 0.15));
  }
}

function ring(at: THREE.Vector3, radius: number): THREE.Mesh {
  const mesh = new THREE.Mesh(new THREE.TorusGeometry(radius, 0.04, 8, 64), kTarget);
  mesh.position.copy(at);
  return mesh;
}

function dot(at: THREE.Vector3, radius: number): THREE.Mesh {
  const mesh = new THREE.Mesh(new THREE.SphereGeometry(radius, 16, 12), kTarget);
  mesh.position.copy(at);
  return mesh;
}

function line(a: THREE.Vector3, b: THREE.Vector3): THREE.Mesh {
  const way = new THREE.Vector3().subVectors(b, a);
  const mesh = new THREE.Mesh(new THREE.CylinderGeometry(0.05, 0.05, way.length(), 8), kTarget);
  mesh.position.copy(a).addScaledVector(way, 0.5);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
  return mesh;
}
