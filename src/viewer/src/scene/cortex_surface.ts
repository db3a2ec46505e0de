// What the cortex looks like: grey-pink tissue under a wet arachnoid, with pial arteries and veins that branch. Painted once, by a
// repeatable chance, on a picture that is laid over the surface; colours of the pressure are laid over that, vertex by vertex.
import * as THREE from "three";
import type { BladeMask } from "./blade_skin";
import { cloud, normalMap, random } from "./textures";

const kTile = 80; // [mm], width of the picture; beyond it is mirrored
const kSize = 2048; // [texel]
const kStep = 0.5; // [mm] of a vessel's way
const kBranches = 18; // of a tree, at most

interface Reach { points: number[]; widths: number[] } // [mm], x y of each point, and its width

/// Which vessel runs where, in cells of the picture: two of a kind do not cross, one ends where another is.
export class Bed {
  private static readonly cell = 0.5; // [mm]
  private readonly across = Math.ceil(kTile / Bed.cell);
  private readonly owner = new Int32Array(this.across * this.across);

  private at(x: number, y: number): number {
    const i = Math.floor(x / Bed.cell), k = Math.floor(y / Bed.cell);
    return i < 0 || k < 0 || i >= this.across || k >= this.across ? -1 : k * this.across + i;
  }
  /// Vessel there, 0 none.
  of(x: number, y: number): number { return this.owner[this.at(x, y)] ?? 0; }
  take(x: number, y: number, around: number, vessel: number): void {
    for (let dy = -around; dy <= around; dy += Bed.cell)
      for (let dx = -around; dx <= around; dx += Bed.cell) {
        const place = this.at(x + dx, y + dy);
        if (place >= 0 && this.owner[place] === 0) this.owner[place] = vessel;
      }
  }
}

interface Sprout { x: number; y: number; way: number; wide: number; side: number; parent: number }

/// Ways of a vessel and all its branches: the heading sways, the width dwindles, branches leave to either side in turn. Parents
/// are laid before their branches.
export function vesselTree(next: () => number, x: number, y: number, heading: number, width: number, thinnest: number, bed = new Bed(), names = { last: 0 }): Reach[] {
  const reaches: Reach[] = [], sprouts: Sprout[] = [{ x, y, way: heading, wide: width, side: next() < 0.5 ? 1 : -1, parent: 0 }];
  let branches = 0;
  for (let sprout = sprouts.shift(); sprout; sprout = sprouts.shift()) {
    const { parent, way: straight } = sprout, name = ++names.last, points = [sprout.x, sprout.y], widths = [sprout.wide];
    let { x: px, y: py, way, wide, side } = sprout, since = 0, bend = 0;
    for (let k = 0; k < 260 && wide > thinnest; ++k) {
      bend = 0.8 * bend + 0.2 * (next() - 0.5);
      way += bend + 0.1 * Math.sin(straight - way);
      px += kStep * Math.cos(way);
      py += kStep * Math.sin(way);
      const other = bed.of(px, py);
      if (other !== 0 && other !== name && (other !== parent || k > 12)) break;
      wide *= 0.992;
      points.push(px, py);
      widths.push(wide);
      since += kStep;
      if (since > 5 + 14 * wide && next() < 0.2 && ++branches < kBranches) {
        since = 0;
        side = -side;
        const share = 0.45 + 0.3 * next();
        sprouts.push({ x: px, y: py, way: way + side * (0.5 + 0.6 * next()), wide: wide * share, side, parent: name });
        wide *= Math.sqrt(1 - 0.45 * share * share);
      }
    }
    for (let k = 0; k < widths.length; ++k) bed.take(points[2 * k], points[2 * k + 1], 0.5 * widths[k] + 0.5, name);
    reaches.push({ points, widths });
  }
  return reaches;
}

function stroke(g: CanvasRenderingContext2D, reaches: Reach[], colour: string, wider: number, add: number, shift = 0): void {
  const scale = kSize / kTile;
  g.strokeStyle = colour;
  g.lineCap = "round";
  for (const { points, widths } of reaches)
    for (let k = 0; k + 1 < widths.length; ++k) {
      g.lineWidth = Math.max(0.6, (widths[k] * wider + add) * scale);
      g.beginPath();
      g.moveTo((points[2 * k] + shift * widths[k]) * scale, (points[2 * k + 1] - shift * widths[k]) * scale);
      g.lineTo((points[2 * k + 2] + shift * widths[k]) * scale, (points[2 * k + 3] - shift * widths[k]) * scale);
      g.stroke();
    }
}

function ground(g: CanvasRenderingContext2D): void {
  const cells = 512, patch = cloud(cells, 12, 5), grain = cloud(cells, 64, 9);
  const small = document.createElement("canvas");
  small.width = small.height = cells;
  const s = small.getContext("2d")!, image = s.createImageData(cells, cells);
  for (let i = 0; i < cells * cells; ++i) {
    const blush = Math.min(1, Math.max(0, 1.6 * (patch[i] - 0.22))), tone = 1 + 0.09 * (grain[i] - 0.47);
    image.data.set([(226 - 12 * blush) * tone, (186 - 34 * blush) * tone, (170 - 30 * blush) * tone, 255], 4 * i);
  }
  s.putImageData(image, 0, 0);
  g.imageSmoothingEnabled = true;
  g.imageSmoothingQuality = "high";
  g.drawImage(small, 0, 0, kSize, kSize);
}

function paintVessels(g: CanvasRenderingContext2D): void {
  const next = random(23);
  const trees = (count: number, widest: number, thinnest: number, bed: Bed, names: { last: number }): Reach[] => Array.from({ length: count }, (_, k) => {
    const angle = (2 * Math.PI * (k + 0.6 * next())) / count, away = kTile * (0.15 + 0.45 * next());
    const x = kTile / 2 + away * Math.cos(angle), y = kTile / 2 + away * Math.sin(angle);
    return vesselTree(next, x, y, angle + Math.PI + 1.6 * (next() - 0.5), widest * (0.7 + 0.3 * next()), thinnest, bed, names);
  }).flat();
  const red = new Bed(), reds = { last: 0 }; // arteries cross veins, but not one another
  const veins = trees(5, 1.3, 0.12, new Bed(), { last: 0 }), arteries = trees(6, 0.7, 0.08, red, reds), fine = trees(16, 0.22, 0.05, red, reds);
  stroke(g, fine, "rgba(176, 62, 58, 0.4)", 1, 0);
  stroke(g, veins, "rgba(92, 40, 48, 0.20)", 1, 0.35);
  stroke(g, veins, "rgb(98, 44, 66)", 1, 0.04);
  stroke(g, veins, "rgb(122, 60, 84)", 0.62, 0);
  stroke(g, veins, "rgba(206, 160, 178, 0.30)", 0.16, 0, 0.16);
  stroke(g, arteries, "rgba(110, 30, 26, 0.22)", 1, 0.3);
  stroke(g, arteries, "rgb(138, 40, 36)", 1, 0.03);
  stroke(g, arteries, "rgb(176, 62, 52)", 0.62, 0);
  stroke(g, arteries, "rgba(255, 190, 170, 0.38)", 0.18, 0, 0.16);
}

let made: { map: THREE.Texture; normal: THREE.Texture } | null | undefined;
/// Colours and fine relief; null where pictures cannot be painted.
function cortexTextures(): { map: THREE.Texture; normal: THREE.Texture } | null {
  if (made !== undefined) return made;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = kSize;
  const g = canvas.getContext("2d");
  if (!g) return (made = null);
  ground(g);
  paintVessels(g);
  const relief = 512, coarse = cloud(relief, 24, 31), fine = cloud(relief, 96, 37);
  const height = Float32Array.from(coarse, (value, i) => 2.2 * value + 0.5 * fine[i]);
  const textures = [canvas, normalMap(height, relief, 1.3)].map((picture) => {
    const texture = new THREE.CanvasTexture(picture);
    texture.wrapS = texture.wrapT = THREE.MirroredRepeatWrapping;
    texture.anisotropy = 8;
    return texture;
  });
  textures[0].colorSpace = THREE.SRGBColorSpace;
  return (made = { map: textures[0], normal: textures[1] });
}

/// Where each vertex lies on the picture: from above, and down the walls of a fissure or the side of a lobe, which their normals tell, as if
/// unrolled. `scale`: mm in a unit of `rest`.
export function cortexUv(rest: number[], normals: ArrayLike<number>, scale: number): Float32Array {
  const uv = new Float32Array((2 * rest.length) / 3);
  for (let i = 0, k = 0; i < rest.length; i += 3, k += 2) {
    const x = rest[i] * scale, y = rest[i + 1] * scale, z = rest[i + 2] * scale, wall = Math.min(1, Math.max(-1, -1.6 * normals[i + 1]));
    uv[k] = x / kTile + 0.5;
    uv[k + 1] = (y + wall * z) / kTile + 0.5;
  }
  return uv;
}

/// Wet tissue; the colour attribute (four numbers) covers it by its fourth. It is not drawn where it lies under a blade.
export function cortexMaterial(painted: boolean, blades: BladeMask): THREE.Material {
  const textures = cortexTextures();
  const common = { vertexColors: true, side: THREE.DoubleSide, map: textures?.map ?? null, color: textures ? 0xffffff : 0xdcb4a4 } as const;
  const material = painted
    ? new THREE.MeshPhongMaterial({ ...common, specular: 0x4a4540, shininess: 70, normalMap: textures?.normal ?? null, normalScale: new THREE.Vector2(0.5, 0.5) })
    : new THREE.MeshPhysicalMaterial({
      ...common, roughness: 0.5, normalMap: textures?.normal ?? null, normalScale: new THREE.Vector2(0.35, 0.35),
      clearcoat: 0.7, clearcoatRoughness: 0.2, clearcoatNormalMap: textures?.normal ?? null, clearcoatNormalScale: new THREE.Vector2(0.1, 0.1),
    });
  material.onBeforeCompile = (shader) => {
    blades.install(shader);
    shader.fragmentShader = shader.fragmentShader.replace("#include <color_fragment>", "diffuseColor.rgb = mix(diffuseColor.rgb, vColor.rgb, vColor.a);");
  };
  return material;
}
