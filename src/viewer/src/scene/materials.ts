// What things are made of. Two sets: physically based for a graphics chip, and painted (matcap) ones that cost a processor
// little and still read as metal, silicone and nylon.
import * as THREE from "three";
import { brushedTextures, sheetTextures } from "./textures";

export const kSheet = 120; // [mm], width of the background sheet

export interface Materials {
  bright: THREE.Material; // titanium forceps
  clamp: THREE.Material; // blasted steel that carries the post
  dark: THREE.Material; // needle holder
  black: THREE.Material; // feet of the post
  grip: THREE.Material; // hard metal inserts
  bands: THREE.Material[]; // rings that tell the instruments apart
  post: THREE.Material;
  sheet: THREE.Material;
  thread: THREE.Material;
}

const kBands = [0x1667c4, 0xd98a12, 0x7a2f91];

export function physicalMaterials(): Materials {
  const brushed = brushedTextures(), sheet = sheetTextures(kSheet / 5, 8);
  const metal = (color: number, roughness: number, scale: number) => new THREE.MeshStandardMaterial({
    color, metalness: 1, roughness, roughnessMap: brushed.rough, normalMap: brushed.normal,
    normalScale: new THREE.Vector2(scale, scale), envMapIntensity: 1.9,
  });
  return {
    bright: metal(0xd3d7dc, 0.34, 0.45),
    clamp: new THREE.MeshStandardMaterial({ color: 0x6f767c, metalness: 0.85, roughness: 0.62 }),
    dark: metal(0xa6a29a, 0.36, 0.4),
    black: new THREE.MeshStandardMaterial({ color: 0x1b2022, metalness: 0.55, roughness: 0.5 }),
    grip: metal(0xb99a5e, 0.62, 1.4),
    bands: kBands.map((color) => new THREE.MeshStandardMaterial({ color, roughness: 0.4, metalness: 0.2 })),
    post: new THREE.MeshPhysicalMaterial({ color: 0xd9bf9f, roughness: 0.5, clearcoat: 0.3, clearcoatRoughness: 0.35 }),
    sheet: new THREE.MeshStandardMaterial({
      map: sheet.map, normalMap: sheet.normal, roughnessMap: sheet.rough, roughness: 1, metalness: 0, normalScale: new THREE.Vector2(0.55, 0.55),
    }),
    thread: new THREE.MeshPhysicalMaterial({ color: 0x0b1020, roughness: 0.34, clearcoat: 0.5, clearcoatRoughness: 0.25, specularIntensity: 0.8 }),
  };
}

/// A lit ball painted once: the picture of a surface for every direction of its normal.
function ball(stops: [number, string][]): THREE.Texture {
  const size = 128, canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const g = canvas.getContext("2d");
  if (g) {
    const shade = g.createRadialGradient(0.36 * size, 0.3 * size, 0, 0.46 * size, 0.44 * size, 0.6 * size);
    for (const [at, colour] of stops) shade.addColorStop(at, colour);
    g.fillStyle = shade;
    g.fillRect(0, 0, size, size);
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}

/// Polished steel between a lamp and a dark room.
export function steelBall(): THREE.Texture {
  return ball([[0, "#ffffff"], [0.14, "#eef1f4"], [0.34, "#a9b0b8"], [0.55, "#6b727a"], [0.78, "#9aa1a9"], [1, "#30363c"]]);
}

/// The same, broad and seen from above along the light: bright to its rim.
export function bladeBall(): THREE.Texture {
  return ball([[0, "#ffffff"], [0.25, "#f3f5f6"], [0.5, "#c3cad0"], [0.8, "#9ba4ab"], [1, "#737c84"]]);
}

export function paintedMaterials(): Materials {
  const painted = (...stops: [number, string][]) => new THREE.MeshMatcapMaterial({ matcap: ball(stops), toneMapped: false });
  const lit = (colour: string, edge: string) => painted([0, "#ffffff"], [0.16, colour], [0.75, edge], [1, edge]);
  return {
    bright: new THREE.MeshMatcapMaterial({ matcap: steelBall(), toneMapped: false }),
    dark: painted([0, "#fffdf6"], [0.12, "#dedad0"], [0.3, "#8f8b84"], [0.55, "#55524d"], [0.8, "#86827b"], [1, "#24221f"]),
    clamp: lit("#9aa2a9", "#3c4349"),
    black: lit("#3a4144", "#0c0f10"),
    grip: painted([0, "#fff3cf"], [0.25, "#c7a868"], [0.6, "#7a633a"], [1, "#33280f"]),
    bands: [lit("#2e83e6", "#0a2f5e"), lit("#f0a52e", "#6b4000"), lit("#a258bd", "#35103f")],
    post: painted([0, "#fff8ec"], [0.3, "#ead4b8"], [0.7, "#b79c7c"], [1, "#6b5640"]),
    sheet: new THREE.MeshBasicMaterial({ map: sheetTextures(kSheet / 5, 1).map, color: new THREE.Color(1.75, 1.55, 1.55), toneMapped: false }),
    thread: painted([0, "#8d97ab"], [0.2, "#2b3347"], [0.5, "#10141f"], [1, "#05070b"]),
  };
}
