// Small procedural textures, drawn once at start: no picture files to load and nothing to license.
import * as THREE from "three";

/// Repeatable noise, so that the same page always looks the same.
export function random(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296;
  };
}

function canvasOf(size: number): [HTMLCanvasElement, CanvasRenderingContext2D] {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  return [canvas, canvas.getContext("2d", { willReadFrequently: true })!];
}

/// Sum of four octaves of value noise that wraps round at the edges. Values 0 ... 1.
export function cloud(size: number, cells: number, seed: number): Float32Array {
  const out = new Float32Array(size * size);
  const next = random(seed);
  let weight = 0.5;
  for (let octave = 0; octave < 4; ++octave, cells *= 2, weight *= 0.5) {
    const lattice = Float32Array.from({ length: cells * cells }, next);
    const fade = (t: number) => t * t * (3 - 2 * t);
    for (let y = 0; y < size; ++y) {
      const v = (y / size) * cells, y0 = Math.floor(v), fy = fade(v - y0), y1 = (y0 + 1) % cells;
      for (let x = 0; x < size; ++x) {
        const u = (x / size) * cells, x0 = Math.floor(u), fx = fade(u - x0), x1 = (x0 + 1) % cells;
        const a = lattice[y0 * cells + x0] * (1 - fx) + lattice[y0 * cells + x1] * fx;
        const b = lattice[y1 * cells + x0] * (1 - fx) + lattice[y1 * cells + x1] * fx;
        out[y * size + x] += weight * (a * (1 - fy) + b * fy);
      }
    }
  }
  return out;
}

function finish(canvas: HTMLCanvasElement, repeat: number, colour: boolean): THREE.CanvasTexture {
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.repeat.set(repeat, repeat);
  texture.anisotropy = 4;
  if (colour) texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}

/// Normal map of a height field given as a function of the pixel.
export function normalMap(height: Float32Array, size: number, strength: number): HTMLCanvasElement {
  const [canvas, g] = canvasOf(size);
  const image = g.createImageData(size, size);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const dx = height[y * size + ((x + 1) % size)] - height[y * size + ((x + size - 1) % size)];
      const dy = height[((y + 1) % size) * size + x] - height[((y + size - 1) % size) * size + x];
      const nx = -dx * strength, ny = dy * strength, inv = 1 / Math.hypot(nx, ny, 1), at = 4 * (y * size + x);
      image.data[at] = 127.5 + 127.5 * nx * inv;
      image.data[at + 1] = 127.5 + 127.5 * ny * inv;
      image.data[at + 2] = 127.5 + 127.5 * inv;
      image.data[at + 3] = 255;
    }
  }
  g.putImageData(image, 0, 0);
  return canvas;
}

export interface SheetTextures { map: THREE.Texture; normal: THREE.Texture; rough: THREE.Texture }

/// The background sheet: soft silicone with a printed millimetre grid. One tile is `tile` mm wide.
export function sheetTextures(tiles: number, anisotropy: number): SheetTextures {
  const size = 512;
  const noise = cloud(size, 8, 7), grain = cloud(size, 64, 11);
  const [canvas, g] = canvasOf(size);
  const image = g.createImageData(size, size);
  for (let i = 0; i < size * size; ++i) {
    const tone = 0.9 + 0.12 * (noise[i] - 0.47) + 0.10 * (grain[i] - 0.47);
    image.data[4 * i] = 84 * tone;
    image.data[4 * i + 1] = 142 * tone;
    image.data[4 * i + 2] = 139 * tone;
    image.data[4 * i + 3] = 255;
  }
  g.putImageData(image, 0, 0);
  g.strokeStyle = "rgba(12,52,60,0.42)";
  for (let k = 0; k < 5; ++k) {
    g.lineWidth = k === 0 ? 4.2 : 2;
    const at = (k * size) / 5 + 1;
    g.beginPath();
    g.moveTo(at, 0); g.lineTo(at, size);
    g.moveTo(0, at); g.lineTo(size, at);
    g.stroke();
  }
  const height = new Float32Array(size * size);
  for (let i = 0; i < height.length; ++i) height[i] = 0.5 * noise[i] + 0.9 * grain[i];
  const [roughCanvas, r] = canvasOf(size);
  const rough = r.createImageData(size, size);
  for (let i = 0; i < height.length; ++i) {
    const value = 255 * Math.min(1, 0.5 + 0.35 * noise[i] + 0.15 * grain[i]);
    rough.data.set([value, value, value, 255], 4 * i);
  }
  r.putImageData(rough, 0, 0);
  const map = finish(canvas, tiles, true);
  map.anisotropy = anisotropy;
  return {
    map,
    normal: finish(normalMap(height, size, 1.6), tiles, false),
    rough: finish(roughCanvas, tiles, false),
  };
}

/// Fine lengthwise scratches of brushed metal (along v).
export function brushedTextures(): { normal: THREE.Texture; rough: THREE.Texture } {
  const size = 256;
  const next = random(3);
  const height = new Float32Array(size * size);
  for (let line = 0; line < 900; ++line) {
    const x = Math.floor(next() * size), y = Math.floor(next() * size), length = 20 + next() * 160, depth = next() - 0.5;
    for (let k = 0; k < length; ++k) height[((y + k) % size) * size + x] += depth * 0.5;
  }
  const [canvas, g] = canvasOf(size);
  const image = g.createImageData(size, size);
  for (let i = 0; i < height.length; ++i) {
    const value = 255 * Math.min(1, Math.max(0, 0.72 + 0.3 * height[i]));
    image.data.set([value, value, value, 255], 4 * i);
  }
  g.putImageData(image, 0, 0);
  return { normal: finish(normalMap(height, size, 0.35), 1, false), rough: finish(canvas, 1, false) };
}
