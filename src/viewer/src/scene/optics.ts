// The microscope as geometry: where the two eyes are, how wide the field is and what is in focus. Millimetres, the scene's
// own axes (z up). No three.js here, so that it can be tested without a screen.
import type { Frame, Scene } from "../messages";

export interface OpticsState {
  magnification: number; // 5 ... 40
  focus: number; // [mm], height of the focal plane
  centre: [number, number]; // [mm], point of the scene in the middle of the field
  tilt: number; // [rad], inclination of the microscope from the vertical, towards the operator
  eyeDistance: number; // [mm], stereo base at the objective
}

export const kMagnificationMin = 5;
export const kMagnificationMax = 40;
export const kMagnificationStart = 8; // less where hands or needle would be outside
export const kMagnificationBrain = 5; // blades, lips and the way between them

/// What is stitched fills a third of the picture at the start, taken as the root of its length times its width [mm].
export function magnificationFor(length: number, width: number): number {
  return clampMagnification(kFieldNumber / (3 * Math.sqrt(Math.max(1e-6, length * width))));
}
/// The greatest magnification up to `wanted` at which what lies `distance` from the middle of the field and reaches `reach` [mm] further is in the picture, a tenth
/// of the field's radius from its edge: a needle that must be taken first has to be seen.
export function magnificationShowing(wanted: number, distance: number, reach: number): number {
  return clampMagnification(Math.min(wanted, (0.9 * kFieldNumber) / (2 * Math.max(1e-6, distance + reach))));
}
const kTipReach = 3; // [mm], of an instrument at rest to be seen besides its tip

/// The greatest magnification up to `wanted` with all in the picture that the first frame says must be taken and moved: needle and instruments. Scissors are brought in later.
export function magnificationAtFirst(wanted: number, scene: Scene, frame: Frame, centre: readonly number[]): number {
  if (scene.brain) return wanted; // blades are as wide as the field
  const distance = ([x, y]: readonly number[]) => Math.hypot(1000 * x - centre[0], 1000 * y - centre[1]);
  const tips = frame.tools.filter((_, k) => scene.tools[k]?.kind !== "scissors").map((tool) => magnificationShowing(wanted, distance(tool.pose.position), kTipReach));
  const needle = scene.tissue && scene.needle && frame.needle ? [magnificationShowing(wanted, distance(frame.needle.pose.position), 1000 * scene.needle.bend_radius)] : [];
  return Math.min(wanted, ...tips, ...needle);
}

export const kTilt = 0.21; // [rad], at which instruments are seen from the operator's side
export const kTiltBrain = 0.1; // [rad], into a fissure: nearly from above, as its target is measured, but no blade quite on edge
export const kWorkingDistance = 200; // [mm], objective to focal plane
export const kFieldNumber = 200; // [mm], field diameter times magnification
export const kAperture = 14; // [mm], of one beam path at the objective; sets the depth of field

export function fieldDiameter(magnification: number): number {
  return kFieldNumber / magnification;
}

export function clampMagnification(value: number): number {
  return Math.min(kMagnificationMax, Math.max(kMagnificationMin, value));
}

/// One zoom step is a fixed ratio, as on a zoom ring.
export function zoomed(magnification: number, steps: number): number {
  return clampMagnification(magnification * Math.pow(1.12, steps));
}

/// Vertical opening angle [rad] of a camera that shows the whole field on a square picture.
export function openingAngle(magnification: number): number {
  return 2 * Math.atan(fieldDiameter(magnification) / 2 / kWorkingDistance);
}

/// Diameter [mm, in the focal plane] over which a point `defocus` mm away from the focal plane is spread.
export function blurDiameter(defocus: number): number {
  return (Math.abs(defocus) * kAperture) / Math.max(1, kWorkingDistance + defocus);
}

export interface Eye {
  position: [number, number, number]; // [mm]
  target: [number, number, number]; // [mm]
  shift: number; // off-axis shift of the picture, as a share of the field diameter at the focal plane
}

/// `side`: -1 left eye, 0 the single eye of the mono view, 1 right eye. Both eyes look parallel and their pictures are
/// shifted so that they agree in the focal plane (off-axis stereo: no keystone error).
export function eyeAt(optics: OpticsState, side: -1 | 0 | 1): Eye {
  const base = (side * optics.eyeDistance) / 2;
  const target: [number, number, number] = [optics.centre[0], optics.centre[1], optics.focus];
  return {
    position: [
      target[0] + base,
      target[1] - kWorkingDistance * Math.sin(optics.tilt),
      target[2] + kWorkingDistance * Math.cos(optics.tilt),
    ],
    target: [target[0] + base, target[1], target[2]],
    shift: -base / fieldDiameter(optics.magnification),
  };
}

/// Scale bar for the reticle: a round length [mm] that fills about a fifth of the field.
export function scaleBar(magnification: number): number {
  const wanted = fieldDiameter(magnification) / 5;
  const decade = Math.pow(10, Math.floor(Math.log10(wanted)));
  for (const step of [5, 2, 1]) {
    if (wanted >= step * decade) return step * decade;
  }
  return decade;
}
