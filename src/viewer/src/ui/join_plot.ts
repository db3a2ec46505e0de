// The cut seen along the vessel: how far its edges gape round it, and where the stitches lie.
import type { Lapse, Leak, Stitch } from "../messages";
import { svg } from "./dom";

const kRing = 72, kReach = 42; // the edge, and a gap of full scale beyond it, in units of the picture
const kScales = [20, 50, 100, 200, 500, 1000, 2000, 5000]; // µm

/// Full scale of the gaps: round, and not below 20 µm, so that a tight join does not look torn. [µm]
export function gapScale(widest: number): number { return kScales.find((one) => one >= widest) ?? kScales[kScales.length - 1]; }

/// Angle zero is on the right, counted anticlockwise. [deg]
function place(degrees: number, radius: number): [number, number] {
  const angle = (degrees * Math.PI) / 180;
  return [radius * Math.cos(angle), -radius * Math.sin(angle)];
}
const at = (degrees: number, radius: number): string => place(degrees, radius).map((value) => value.toFixed(2)).join(" ");

/// Where a stitch lies round the cut, whose length is `round`. [deg]
export function stitchAngle(stitch: Stitch, round: number): number | null {
  return stitch.position_m === null || !(round > 0) ? null : ((360 * stitch.position_m) / round + 360) % 360;
}

export function joinPlot(leak: Leak, stitches: readonly Stitch[], lapses: readonly Lapse[]): SVGElement | null {
  const { edge, round_m: round } = leak;
  if (!edge || edge.length < 3 || !round) return null;
  const widest = edge.reduce((most, one) => ((one.gap_m ?? 0) > (most.gap_m ?? 0) ? one : most));
  const full = gapScale(1e6 * (widest.gap_m ?? 0));
  const outline = edge.map(({ angle_deg, gap_m }) => at(angle_deg, kRing + (kReach * 1e6 * (gap_m ?? 0)) / full)).join("L");
  const marks = stitches.map((stitch, k) => {
    const angle = stitchAngle(stitch, round);
    if (angle === null) return "";
    const warned = lapses.some((lapse) => lapse.stitch === k);
    const [x, y] = place(angle, kRing - 24);
    return `<path class="stitchmark" d="M${at(angle, kRing - 12)}L${at(angle, kRing + 10)}"/><text x="${x.toFixed(2)}" y="${y.toFixed(2)}">${k + 1}${warned ? "△" : ""}</text>`;
  });
  const compass = [0, 90, 180, 270].map((angle) => { const [x, y] = place(angle, kRing + kReach + 18); return `<text class="quiet" x="${x.toFixed(2)}" y="${y.toFixed(2)}">${angle}°</text>`; });
  const label = `Gap between the cut edges seen along the vessel: at most ${(1e6 * (widest.gap_m ?? 0)).toFixed(0)} µm, at ${widest.angle_deg.toFixed(0)}°; ${stitches.length} stitches`;
  return svg(`<svg viewBox="-150 -150 300 300" role="img" aria-label="${label}" class="joinplot">
    <circle class="scale" r="${kRing + kReach}"/><path class="gap" fill-rule="evenodd" d="M${outline}ZM${at(0, kRing)}A${kRing} ${kRing} 0 1 0 ${at(180, kRing)}A${kRing} ${kRing} 0 1 0 ${at(0, kRing)}Z"/>
    <circle class="edge" r="${kRing}"/>${marks.join("")}${compass.join("")}<text class="quiet" y="-2">gap to the</text><text class="quiet" y="12">dashes: ${full} µm</text></svg>`);
}
