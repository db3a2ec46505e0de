// A surface drawn through cross sections along a centre line: what all instruments are made of. Millimetres.
import * as THREE from "three";

export interface Section {
  at: [number, number, number]; // centre of the section
  yaw: number; // [rad], rotation of the section about y (the hinge direction)
  width: number; // [mm], half extent along x, on the outer side
  height: number; // [mm], half extent along y
  inner: number; // [mm], half extent along x on the inner side
  square: number; // 2 = round, larger = more square
}

const kArc = 14; // points on the outer side of a section

/// Points of a section in its own x-y plane, counter-clockwise as seen from +z.
function outline(section: Section, out: [number, number][]): void {
  out.length = 0;
  const power = 2 / section.square;
  for (let k = 0; k <= kArc; ++k) {
    const angle = -Math.PI / 2 + (Math.PI * k) / kArc;
    const c = Math.cos(angle), s = Math.sin(angle);
    out.push([section.width * Math.pow(Math.max(0, c), power), section.height * Math.sign(s) * Math.pow(Math.abs(s), power)]);
  }
  for (let k = 1; k < kArc; ++k) {
    const angle = Math.PI / 2 + (Math.PI * k) / kArc;
    const c = Math.cos(angle), s = Math.sin(angle);
    out.push([-section.inner * Math.pow(Math.max(0, -c), power), section.height * Math.sign(s) * Math.pow(Math.abs(s), power)]);
  }
}

/// `mirror` builds the other half of a pair of jaws (x -> -x) with its faces still outwards.
export function loft(sections: Section[], mirror: boolean): THREE.BufferGeometry {
  const around = 2 * kArc; // points of one outline
  const flip = mirror ? -1 : 1;
  const position: number[] = [], uv: number[] = [], index: number[] = [];
  const ring: [number, number][] = [];
  let along = 0;
  sections.forEach((section, row) => {
    outline(section, ring);
    if (row > 0) along += Math.hypot(...section.at.map((v, i) => v - sections[row - 1].at[i]));
    const c = Math.cos(section.yaw), s = Math.sin(section.yaw);
    for (let k = 0; k <= around; ++k) {
      const [x, y] = ring[k % around];
      position.push(flip * (section.at[0] + c * x), section.at[1] + y, section.at[2] - s * x);
      uv.push(k / around, along / 6);
    }
  });
  const stride = around + 1;
  for (let row = 0; row + 1 < sections.length; ++row) {
    for (let k = 0; k < around; ++k) {
      const a = row * stride + k, b = a + 1, c = a + stride, d = c + 1;
      if (mirror) index.push(a, c, b, b, c, d);
      else index.push(a, b, c, b, d, c);
    }
  }
  cap(position, uv, index, 0, stride, mirror);
  cap(position, uv, index, (sections.length - 1) * stride, stride, !mirror);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
  geometry.setAttribute("uv", new THREE.Float32BufferAttribute(uv, 2));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

function cap(position: number[], uv: number[], index: number[], start: number, stride: number, flip: boolean): void {
  const centre = [0, 0, 0];
  for (let k = 0; k + 1 < stride; ++k) for (let i = 0; i < 3; ++i) centre[i] += position[3 * (start + k) + i] / (stride - 1);
  const middle = position.length / 3;
  position.push(...centre); uv.push(0.5, 0);
  const first = middle + 1;
  for (let k = 0; k < stride; ++k) {
    position.push(...position.slice(3 * (start + k), 3 * (start + k) + 3));
    uv.push(k / stride, 0);
  }
  for (let k = 0; k + 1 < stride; ++k) {
    if (flip) index.push(middle, first + k, first + k + 1);
    else index.push(middle, first + k + 1, first + k);
  }
}
