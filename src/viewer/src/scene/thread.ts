// The suture as a smooth round tube. Buffers are sized once for the largest node count; a frame only overwrites them, so
// drawing allocates nothing however often the number of nodes changes.
import * as THREE from "three";

export const kSides = 8; // faces round the thread
export const kSubdivisions = 4; // rings per edge

export class ThreadTube {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.Material>;
  private readonly position: THREE.BufferAttribute;
  private readonly normal: THREE.BufferAttribute;
  private readonly index: THREE.BufferAttribute;
  private rings = 0;
  private triangles = 0;
  // frame carried from ring to ring
  private nx = 0; private ny = 0; private nz = 0;

  constructor(readonly capacity: number, material: THREE.Material) {
    const rings = (capacity + 2) * kSubdivisions;
    this.position = new THREE.BufferAttribute(new Float32Array(rings * (kSides + 1) * 3), 3).setUsage(THREE.DynamicDrawUsage);
    this.normal = new THREE.BufferAttribute(new Float32Array(rings * (kSides + 1) * 3), 3).setUsage(THREE.DynamicDrawUsage);
    this.index = new THREE.BufferAttribute(new Uint32Array(rings * kSides * 6), 1).setUsage(THREE.DynamicDrawUsage);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.position);
    geometry.setAttribute("normal", this.normal);
    geometry.setIndex(this.index);
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
  }

  get ringCount(): number { return this.rings; }
  get triangleCount(): number { return this.triangles; }

  /// `nodes`: x y z of each node [mm]; `radius` [mm]; `gaps`: edges that are cut or broken (nothing is drawn there).
  update(nodes: ArrayLike<number>, count: number, radius: number, gaps: readonly number[] = []): void {
    this.rings = 0;
    this.triangles = 0;
    const last = Math.min(count, this.capacity) - 1;
    let first = 0;
    for (let edge = 0; edge <= last; ++edge) {
      if (edge === last || gaps.includes(edge)) {
        if (edge > first) this.strand(nodes, first, edge, radius);
        first = edge + 1;
      }
    }
    this.position.needsUpdate = this.normal.needsUpdate = this.index.needsUpdate = true;
    this.position.clearUpdateRanges(); this.position.addUpdateRange(0, this.rings * (kSides + 1) * 3);
    this.normal.clearUpdateRanges(); this.normal.addUpdateRange(0, this.rings * (kSides + 1) * 3);
    this.index.clearUpdateRanges(); this.index.addUpdateRange(0, this.triangles * 3);
    this.mesh.geometry.setDrawRange(0, this.triangles * 3);
  }

  private strand(nodes: ArrayLike<number>, first: number, last: number, radius: number): void {
    this.nx = this.ny = this.nz = 0;
    for (let edge = first; edge < last; ++edge) {
      const a = 3 * Math.max(first, edge - 1), b = 3 * edge, c = 3 * (edge + 1), d = 3 * Math.min(last, edge + 2);
      const steps = edge === last - 1 ? kSubdivisions + 1 : kSubdivisions;
      for (let k = 0; k < steps; ++k) {
        const t = k / kSubdivisions;
        this.ring(nodes, a, b, c, d, t, radius, edge > first || k > 0);
      }
    }
  }

  /// One ring at parameter t of the uniform Catmull-Rom piece b-c.
  private ring(p: ArrayLike<number>, a: number, b: number, c: number, d: number, t: number, radius: number, joined: boolean): void {
    const t2 = t * t, t3 = t2 * t;
    const wa = 0.5 * (-t3 + 2 * t2 - t), wb = 0.5 * (3 * t3 - 5 * t2 + 2), wc = 0.5 * (-3 * t3 + 4 * t2 + t), wd = 0.5 * (t3 - t2);
    const da = 0.5 * (-3 * t2 + 4 * t - 1), db = 0.5 * (9 * t2 - 10 * t), dc = 0.5 * (-9 * t2 + 8 * t + 1), dd = 0.5 * (3 * t2 - 2 * t);
    const x = wa * p[a] + wb * p[b] + wc * p[c] + wd * p[d];
    const y = wa * p[a + 1] + wb * p[b + 1] + wc * p[c + 1] + wd * p[d + 1];
    const z = wa * p[a + 2] + wb * p[b + 2] + wc * p[c + 2] + wd * p[d + 2];
    let tx = da * p[a] + db * p[b] + dc * p[c] + dd * p[d];
    let ty = da * p[a + 1] + db * p[b + 1] + dc * p[c + 1] + dd * p[d + 1];
    let tz = da * p[a + 2] + db * p[b + 2] + dc * p[c + 2] + dd * p[d + 2];
    const length = Math.hypot(tx, ty, tz) || 1;
    tx /= length; ty /= length; tz /= length;
    this.turnFrame(tx, ty, tz);
    const { nx, ny, nz } = this;
    const bx = ty * nz - tz * ny, by = tz * nx - tx * nz, bz = tx * ny - ty * nx;
    const pos = this.position.array, nor = this.normal.array;
    let at = this.rings * (kSides + 1) * 3;
    for (let s = 0; s <= kSides; ++s, at += 3) {
      const u = kCos[s], v = kSin[s];
      const ox = u * nx + v * bx, oy = u * ny + v * by, oz = u * nz + v * bz;
      nor[at] = ox; nor[at + 1] = oy; nor[at + 2] = oz;
      pos[at] = x + radius * ox; pos[at + 1] = y + radius * oy; pos[at + 2] = z + radius * oz;
    }
    if (joined) this.join();
    ++this.rings;
  }

  /// Takes the part along the tangent out of the carried normal: least turning from ring to ring.
  private turnFrame(tx: number, ty: number, tz: number): void {
    let along = this.nx * tx + this.ny * ty + this.nz * tz;
    let nx = this.nx - along * tx, ny = this.ny - along * ty, nz = this.nz - along * tz;
    let length = Math.hypot(nx, ny, nz);
    if (length < 1e-3) {
      const useX = Math.abs(tx) < 0.7;
      along = useX ? tx : ty;
      nx = (useX ? 1 : 0) - along * tx; ny = (useX ? 0 : 1) - along * ty; nz = -along * tz;
      length = Math.hypot(nx, ny, nz);
    }
    this.nx = nx / length; this.ny = ny / length; this.nz = nz / length;
  }

  private join(): void {
    const index = this.index.array;
    const here = this.rings * (kSides + 1), before = here - (kSides + 1);
    let at = this.triangles * 3;
    for (let s = 0; s < kSides; ++s) {
      index[at++] = before + s; index[at++] = here + s; index[at++] = before + s + 1;
      index[at++] = before + s + 1; index[at++] = here + s; index[at++] = here + s + 1;
    }
    this.triangles += 2 * kSides;
  }
}

const kCos = Float64Array.from({ length: kSides + 1 }, (_, s) => Math.cos((2 * Math.PI * s) / kSides));
const kSin = Float64Array.from({ length: kSides + 1 }, (_, s) => Math.sin((2 * Math.PI * s) / kSides));
