// Blades against the drawn tissue, and what they look like. A cortex is drawn through its nodes, some millimetres apart: between
// one that lies on a blade and one beside it the triangle cuts through the steel. Tissue on the wrong side of a blade, or in
// its plane, is not drawn where the blade would be seen behind it.
import * as THREE from "three";
import type { BrainShape } from "../messages";

type Form = BrainShape["blades"][number]["forms"][number];

const kBlades = 2;
const kRows = 12; // of a blade's course, at most
const kMm = 1000;

/// The course of a blade in its own frame, tip first: y, z and half its width there [mm]; only where it bends or widens, and only
/// what is drawn, up to `shown` [m] along z.
export function courseOf(form: Form, shown: number): THREE.Vector3[] {
  const rows: THREE.Vector3[] = [];
  for (let i = 0; i + 2 < form.vertices.length; i += 3) {
    if (form.vertices[i + 2] > shown) continue;
    const y = form.vertices[i + 1] * kMm, z = form.vertices[i + 2] * kMm, half = Math.abs(form.vertices[i]) * kMm, last = rows[rows.length - 1];
    if (last && Math.hypot(last.x - y, last.y - z) < 1e-3) last.z = Math.max(last.z, half);
    else rows.push(new THREE.Vector3(y, z, half));
  }
  for (let limit = 0.02; ; limit *= 2) {
    const kept = simplified(rows, limit);
    if (kept.length <= kRows) return kept;
  }
}

/// Rows without those that are within `limit` [mm] of the line between their neighbours (Douglas & Peucker 1973).
function simplified(rows: THREE.Vector3[], limit: number): THREE.Vector3[] {
  if (rows.length < 3) return rows;
  const line = new THREE.Line3(rows[0], rows[rows.length - 1]), foot = new THREE.Vector3();
  let far = 0, at = 0;
  for (let k = 1; k + 1 < rows.length; ++k) {
    const away = line.closestPointToPoint(rows[k], true, foot).distanceTo(rows[k]);
    if (away > far) [far, at] = [away, k];
  }
  if (far <= limit) return [rows[0], rows[rows.length - 1]];
  return [...simplified(rows.slice(0, at + 1), limit).slice(0, -1), ...simplified(rows.slice(at), limit)];
}

/// Where the blades are, for the shader of the tissue.
export class BladeMask {
  private readonly from = Array.from({ length: kBlades }, () => new THREE.Matrix4());
  private readonly rows = Array.from({ length: kBlades * kRows }, () => new THREE.Vector3());
  private readonly counts = { value: new Array<number>(kBlades).fill(0) };
  private readonly courses: THREE.Vector3[][][];

  constructor(blades: BrainShape["blades"], shown: number) {
    this.courses = blades.slice(0, kBlades).map((blade) => blade.forms.map((form) => courseOf(form, shown)));
  }

  /// Blade `k` has this form and stands there.
  place(k: number, form: number, blade: THREE.Object3D): void {
    const course = this.courses[k]?.[form];
    if (!course) return;
    blade.updateMatrix();
    this.from[k].copy(blade.matrix).invert();
    this.counts.value[k] = course.length;
    course.forEach((row, i) => this.rows[k * kRows + i].copy(row));
  }

  /// Adds the test to a material's shader.
  install(shader: THREE.WebGLProgramParametersWithUniforms): void {
    Object.assign(shader.uniforms, { bladeFrom: { value: this.from }, bladeRows: { value: this.rows }, bladeCount: this.counts });
    shader.vertexShader = `varying vec3 vPlace, vOutward;\n${shader.vertexShader}`.replace("#include <begin_vertex>", "#include <begin_vertex>\nvPlace = position; vOutward = normal;");
    shader.fragmentShader = `${kTest}\n${shader.fragmentShader}`.replace("#include <clipping_planes_fragment>", "#include <clipping_planes_fragment>\nif (underBlade()) discard;");
  }
}

const kTest = /* glsl */ `
varying vec3 vPlace, vOutward;
uniform mat4 bladeFrom[${kBlades}];
uniform vec3 bladeRows[${kBlades * kRows}]; // y, z, half the width [mm]
uniform int bladeCount[${kBlades}];
const float kPlane = 0.12; // [mm], as near as this counts as in the blade
const float kRim = 0.08;   // [mm], of a blade that its own edge is drawn in
const float kDeep = 4.0;   // [mm], a spacing of the nodes: further through is another fold
bool underBlade() {
  for (int b = 0; b < ${kBlades}; ++b) {
    vec3 p = (bladeFrom[b] * vec4(vPlace, 1.0)).xyz, eye = (bladeFrom[b] * vec4(cameraPosition, 1.0)).xyz;
    vec2 outward = (mat3(bladeFrom[b]) * normalize(vOutward)).yz;
    for (int k = 0; k + 1 < bladeCount[b]; ++k) {
      vec3 row = bladeRows[b * ${kRows} + k], way = bladeRows[b * ${kRows} + k + 1] - row;
      vec2 across = normalize(vec2(way.y, -way.x));
      float gap = dot(p.yz - row.xy, across), facing = dot(outward, across), high = dot(eye.yz - row.xy, across);
      if (abs(facing) < 0.1 || abs(gap) > kDeep || gap * sign(facing) < -kPlane || abs(high - gap) < 1e-6) continue;
      vec3 seen = eye + (p - eye) * (high / (high - gap)); // of the blade, along the same ray
      float along = dot(seen.yz - row.xy, way.xy) / dot(way.xy, way.xy);
      if (along >= 0.0 && along <= 1.0 && abs(seen.x) <= row.z + along * way.z - kRim) return true;
    }
  }
  return false;
}`;

/// Rolled steel: fine scratches along the blade, its ground edges bright. Null where pictures cannot be painted.
function steelTexture(): THREE.Texture | null {
  const canvas = document.createElement("canvas"), wide = 128, long = 512;
  canvas.width = wide;
  canvas.height = long;
  const g = canvas.getContext("2d");
  if (!g) return null;
  g.fillStyle = "rgb(206 211 215)";
  g.fillRect(0, 0, wide, long);
  for (let k = 0; k < 900; ++k) { // low-discrepancy places: the same each time, no stripes
    const x = (k * 0.7548776662 * wide) % wide, y = (k * 0.5698402910 * long) % long, length = 30 + ((k * 53) % 140);
    g.fillStyle = k % 2 === 0 ? "rgb(255 255 255 / 0.04)" : "rgb(60 66 72 / 0.03)";
    g.fillRect(x, y, 1.6, length);
  }
  g.strokeStyle = "rgb(255 255 255 / 0.85)";
  g.lineWidth = 7;
  g.strokeRect(0, -20, wide, long + 20);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}

/// A polished blade, by pictures alone (`matcap`, a lit ball) or by the room's light.
export function bladeMaterial(matcap: THREE.Texture | null): THREE.Material {
  const map = steelTexture();
  if (matcap) return new THREE.MeshMatcapMaterial({ matcap, map, side: THREE.DoubleSide, toneMapped: false });
  return new THREE.MeshStandardMaterial({ color: 0xe4e8ea, map, metalness: 1, roughness: 0.32, envMapIntensity: 1.9, side: THREE.DoubleSide });
}

/// Picture coordinates and normals of a drawn blade. Its normals lean outwards as if it were rolled a little across, as malleable
/// steel is, and towards the light above: a mirror that is quite flat and on edge shows one dark grey.
export function polish(geometry: THREE.BufferGeometry, shown: number): void {
  const p = geometry.getAttribute("position"), n = geometry.getAttribute("normal"), uv = new Float32Array(2 * p.count), lean = new THREE.Vector3();
  const half = new Map<number, number>();
  for (let i = 0; i < p.count; ++i) half.set(Math.round(50 * p.getZ(i)), Math.max(half.get(Math.round(50 * p.getZ(i))) ?? 0, Math.abs(p.getX(i))));
  for (let i = 0; i < p.count; ++i) {
    const out = p.getX(i) / (half.get(Math.round(50 * p.getZ(i))) || 1);
    uv.set([0.5 + 0.5 * out, 1 - p.getZ(i) / shown], 2 * i);
    lean.set(n.getX(i) + 0.4 * out, n.getY(i), n.getZ(i) + 0.5 + 0.25 * (1 - (2 * p.getZ(i)) / shown)).normalize();
    n.setXYZ(i, lean.x, lean.y, lean.z);
  }
  geometry.setAttribute("uv", new THREE.BufferAttribute(uv, 2));
}
