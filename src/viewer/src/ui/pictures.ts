// Pictures of tasks and knots, drawn from a description of the throws: one row of crossings for each throw.
import { svg } from "./dom";

/// A throw: how many times the two strands cross (3 for a single throw, 5 for a double one) and in which sense they turn.
export interface Throw { crossings: 3 | 5 | 1; sense: 1 | -1 }

type Point = [number, number, number]; // x, y, height above the paper

export const kThrows: Record<string, Throw[]> = {
  square: [{ crossings: 3, sense: 1 }, { crossings: 3, sense: -1 }],
  granny: [{ crossings: 3, sense: 1 }, { crossings: 3, sense: 1 }],
  surgeons: [{ crossings: 5, sense: 1 }, { crossings: 3, sense: -1 }],
  triple: [{ crossings: 3, sense: 1 }, { crossings: 3, sense: -1 }, { crossings: 3, sense: 1 }],
  overhand: [{ crossings: 3, sense: 1 }],
  "half-hitches": [{ crossings: 1, sense: 1 }, { crossings: 3, sense: 1 }],
};

const kHalfWidth = 22, kHeight = 7.5, kSpacing = 27;

function bezier(p: [number, number][]): Point[] {
  return Array.from({ length: 9 }, (_, k): Point => {
    const t = k / 8, u = 1 - t, w = [u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t];
    return [w.reduce((sum, v, i) => sum + v * p[i][0], 0), w.reduce((sum, v, i) => sum + v * p[i][1], 0), 0];
  });
}

const mirrored = (points: Point[]): Point[] => points.map(([x, y, z]) => [-x, y, z]);

/// The two strands of a knot from the post upwards: each a list of points. Paper coordinates, y downwards.
export function strands(throws: Throw[], base: number): [Point[], Point[]] {
  const rise = bezier([[-15, base + 30], [-16, base + 17], [-40, base + kHeight + 1], [-kHalfWidth, base + kHeight]]);
  const left = rise.slice(0, -1), right = mirrored(left);
  let a = left, b = right; // a stands at the lower left of the next throw, b at the lower right
  throws.forEach((one, row) => {
    const y = base - row * kSpacing, n = one.crossings, steps = n * 8, next = y - kSpacing + kHeight;
    const forth: Point[] = [], back: Point[] = [];
    for (let k = 0; k <= steps; ++k) {
      const turn = (Math.PI * n * k) / steps, x = -kHalfWidth + (2 * kHalfWidth * k) / steps;
      forth.push([x, y + kHeight * Math.cos(turn), one.sense * Math.sin(turn)]);
      back.push([x, y - kHeight * Math.cos(turn), -one.sense * Math.sin(turn)]);
    }
    const out = row + 1 < throws.length
      ? bezier([[kHalfWidth, y - kHeight], [kHalfWidth + 10, y - kHeight], [kHalfWidth + 10, next], [kHalfWidth, next]]).slice(1, -1)
      : bezier([[kHalfWidth, y - kHeight], [kHalfWidth + 10, y - kHeight], [34, y - 14], [47, y - 20]]).slice(1);
    a.push(...forth, ...out);
    b.push(...back.reverse(), ...mirrored(out));
    [a, b] = [b, a]; // the strand that came from the right now stands at the left
  });
  return [left, right];
}

/// Catmull-Rom through the points, `density` pieces each.
function smoothed(points: Point[], density: number): Point[] {
  const out: Point[] = [];
  for (let i = 0; i + 1 < points.length; ++i) {
    const p = [points[Math.max(0, i - 1)], points[i], points[i + 1], points[Math.min(points.length - 1, i + 2)]];
    for (let k = 0; k < density; ++k) {
      const t = k / density, t2 = t * t, t3 = t2 * t;
      const w = [0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t), 0.5 * (t3 - t2)];
      out.push([0, 1, 2].map((axis) => w.reduce((sum, weight, j) => sum + weight * p[j][axis], 0)) as Point);
    }
  }
  out.push(points[points.length - 1]);
  return out;
}

/// Short pieces painted from the lowest to the highest, each with a dark rim: crossings come out right by themselves.
function paint(lines: { points: Point[]; colour: string }[], width: number, rim: string): string {
  const pieces: { height: number; path: string; colour: string }[] = [];
  for (const { points, colour } of lines) {
    const fine = smoothed(points, 2);
    for (let i = 0; i + 1 < fine.length; i += 4) {
      const part = fine.slice(i, i + 5);
      const height = part.reduce((sum, p) => sum + p[2], 0) / part.length;
      pieces.push({ height, colour, path: "M" + part.map((p) => `${p[0].toFixed(1)} ${p[1].toFixed(1)}`).join("L") });
    }
  }
  pieces.sort((p, q) => p.height - q.height);
  return pieces.map(({ path, colour }) =>
    `<path d="${path}" fill="none" stroke="${rim}" stroke-width="${width + 1.8}"/>` +
    `<path d="${path}" fill="none" stroke="${colour}" stroke-width="${width}" stroke-linecap="round" stroke-linejoin="round"/>`).join("");
}

let serial = 0;

function field(content: string, label: string): SVGElement {
  const id = `field${++serial}`;
  return svg(`<svg viewBox="-60 -60 120 120" role="img" aria-label="${label}" class="picture">
    <defs>
      <radialGradient id="${id}"><stop offset="0" stop-color="#8fc0b8"/><stop offset=".8" stop-color="#5f9a96"/><stop offset="1" stop-color="#33615f"/></radialGradient>
      <clipPath id="${id}c"><circle r="56"/></clipPath>
      <linearGradient id="${id}m" x1="0" x2="0" y1="0" y2="1"><stop offset="0" stop-color="#eef2f5"/><stop offset=".5" stop-color="#9aa5b0"/><stop offset="1" stop-color="#5b6570"/></linearGradient>
      <linearGradient id="${id}p" x1="0" x2="0" y1="0" y2="1"><stop offset="0" stop-color="#fff1de"/><stop offset="1" stop-color="#c9ab8c"/></linearGradient>
    </defs>
    <circle r="59" fill="#050808"/><circle r="56" fill="url(#${id})"/>
    <g clip-path="url(#${id}c)">${content.replaceAll("#METAL", `url(#${id}m)`).replaceAll("#POST", `url(#${id}p)`)}</g>
    <circle r="56" fill="none" stroke="#0b1414" stroke-width="3"/></svg>`);
}

/// The knot as a diagram above the post. `tools`: with the tips of two instruments pulling the tails.
export function knotPicture(knot: string, label: string, tools: boolean, scale = 1): SVGElement {
  const throws = kThrows[knot] ?? [];
  const base = 8 + (throws.length - 2) * kSpacing * 0.5;
  if (throws.length === 0) {
    const loose = "M-50 -20C-20 10 -18 -34 0 -12S24 24 50 -14";
    return field(`<path d="${loose}" fill="none" stroke="#12333b" stroke-width="4.5" stroke-linecap="round"/>`, label);
  }
  const [left, right] = strands(throws, base);
  const post = `<ellipse cx="3" cy="${base + 46}" rx="22" ry="5" fill="#00000038"/>
    <circle cy="${base + 30}" r="13" fill="#POST" stroke="#6d5a46" stroke-width=".8"/>`;
  const round = `<path d="M-15 ${base + 30}A15 15 0 0 0 0 ${base + 45}" fill="none" stroke="#12324a" stroke-width="4.2"/><path d="M15 ${base + 30}A15 15 0 0 1 0 ${base + 45}" fill="none" stroke="#7a2b16" stroke-width="4.2"/>`;
  const knotPaths = paint([{ points: left, colour: "#12324a" }, { points: right, colour: "#7a2b16" }], 4.2, "#2c5556");
  const top = base - (throws.length - 1) * kSpacing - 19;
  const jaws = tools ? `<g stroke="#2b333b" stroke-width=".6">
    <path d="M-40 ${top - 2}L-64 ${top - 20}L-64 ${top - 12}L-41 ${top + 1}Z" fill="#METAL"/><path d="M-40 ${top + 3}L-64 ${top + 2}L-64 ${top - 7}L-41 ${top + 0}Z" fill="#METAL"/>
    <path d="M40 ${top - 2}L64 ${top - 20}L64 ${top - 12}L41 ${top + 1}Z" fill="#METAL"/><path d="M40 ${top + 3}L64 ${top + 2}L64 ${top - 7}L41 ${top + 0}Z" fill="#METAL"/></g>` : "";
  return field(`<g transform="scale(${scale})">${post + round + knotPaths + jaws}</g>`, label);
}

/// Cortex with its furrows and a spatula on it; two blades apart where the task opens a fissure.
function brainPicture(label: string, blades: number): SVGElement {
  const furrows = [-44, -30, -16, 0, 16, 30, 44].map((x, k) => `<path d="M${x} -58C${x + 9} -34 ${x - 10} -14 ${x + (k % 2 ? 6 : -6)} 8S${x + 8} 40 ${x - 2} 58" fill="none" stroke="#8d4a44" stroke-width="${k === 3 ? 4 : 2.2}"/>`).join("");
  const vessels = `<path d="M-58 -8C-34 -20 -20 4 4 -6S38 -26 58 -12M-10 58C-16 34 6 26 2 2" fill="none" stroke="#a3262a" stroke-width="1.8"/>`;
  const blade = (x: number, turn: number) => `<g transform="translate(${x} 6) rotate(${turn})"><path d="M-8 62V-6C-8 -18 8 -18 8 -6V62Z" fill="#METAL" stroke="#2b333b" stroke-width=".8"/></g>`;
  return field(`<rect x="-60" y="-60" width="120" height="120" fill="#d9a79b"/>${furrows}${vessels}${blades === 2 ? blade(-15, 14) + blade(15, -14) : blade(10, -10)}`, label);
}

const kBlades: Record<string, number> = { "press-to-target": 1, "hold-exposure": 1, "deep-exposure": 1, "retractor-correction": 1, "sylvian-opening": 2 };

const kThread = `fill="none" stroke="#12324a" stroke-width="2.6" stroke-linecap="round"`;

/// The needle's arc with its point, about (x, y), turned by `turn` degrees.
const needle = (x: number, y: number, turn: number, size = 1): string =>
  `<g transform="translate(${x} ${y}) rotate(${turn}) scale(${size})"><path d="M-17 0A17 17 0 0 1 17 0" fill="none" stroke="#2b333b" stroke-width="4.2"/><path d="M-17 0A17 17 0 0 1 17 0" fill="none" stroke="#dfe5ea" stroke-width="2.8"/><path d="M15.4 0L17 8L18.6 0Z" fill="#dfe5ea"/></g>`;

/// Two stumps in their clamps, cut edges facing.
function stumps(colour: string): string {
  const stump = (end: number) => `<g transform="scale(${end} 1)"><rect x="5" y="-17" width="60" height="34" fill="${colour}" stroke="#5b3a34" stroke-width=".8"/><rect x="5" y="-15" width="60" height="7" fill="#ffffff48"/>
    <ellipse cx="5" rx="4.5" ry="17" fill="#7c3b36" stroke="${colour}" stroke-width="2.4"/><path d="M40 -23H46V23H40Z" fill="#METAL" stroke="#2b333b" stroke-width=".6"/></g>`;
  return stump(-1) + stump(1);
}

/// Two stumps in their clamps with a stitch across the gap; `turns`: of the thread in its knot, so far.
function vesselPicture(label: string, colour: string, turns: number): SVGElement {
  const knot = Array.from({ length: turns }, (_, k) => `<ellipse cx="0" cy="${-4 * k}" rx="6" ry="3.4" ${kThread}/>`).join("");
  const thread = turns > 0 ? `<path d="M-15 0H15" ${kThread}/>${knot}<path d="M-4 ${-4 * turns}C-14 -26 -22 -34 -30 -44M4 ${-4 * turns}C12 -24 20 -34 30 -42" ${kThread}/>`
    : `<path d="M-24 -4C-34 -22 -26 -38 -12 -44M-24 -4H16C24 -4 26 -20 26 -26" ${kThread}/>${needle(30, -30, 60, 0.8)}`;
  return field(stumps(colour) + thread, label);
}

/// Two tips that lift one of the stumps by a fold of its outside.
function handlingPicture(label: string): SVGElement {
  return field(`${stumps("#cf8378")}<path d="M-40 -14C-34 -16 -32 -24 -30 -24S-26 -16 -20 -14Z" fill="#cf8378" stroke="#7a3f38" stroke-width=".8"/>
    <g stroke="#2b333b" stroke-width=".6"><path d="M-32 -20L-44 -62H-34Z" fill="#METAL"/><path d="M-28 -20L-16 -62H-26Z" fill="#METAL"/></g>`, label);
}

/// A stitch as it should be, and a needle beside it that goes down through both walls of one stump, far from the edge.
function lapsesPicture(label: string): SVGElement {
  return field(`${stumps("#dcc8b6")}<path d="M-12 -6H12C22 -8 24 -22 30 -36" ${kThread}/>${needle(-30, 4, 90, 1.3)}<circle cx="-22" cy="17" r="10" fill="none" stroke="#a3282a" stroke-width="2" stroke-dasharray="4 3"/>`, label);
}

/// The join seen along the vessel: stitches at `first` [degrees, from the left over the top] are made first, with long ends, those at `then` after them.
function joinPicture(label: string, first: number[], then: number[]): SVGElement {
  const at = (degrees: number, r: number) => `${(-r * Math.cos((Math.PI * degrees) / 180)).toFixed(1)} ${(-r * Math.sin((Math.PI * degrees) / 180)).toFixed(1)}`;
  const stitch = (degrees: number, reach: number) => `<path d="M${at(degrees, 21)}L${at(degrees, reach)}" ${kThread}/><circle cx="${at(degrees, 36).split(" ")[0]}" cy="${at(degrees, 36).split(" ")[1]}" r="3.2" fill="#12324a"/>`;
  return field(`<circle r="29" fill="#7c3b36"/><circle r="29" fill="none" stroke="#dcc8b6" stroke-width="10"/><circle r="34.5" fill="none" stroke="#5b3a34" stroke-width=".8"/>` +
    then.map((a) => `<g opacity=".45">${stitch(a, 36)}</g>`).join("") + first.map((a) => stitch(a, 54)).join(""), label);
}

/// A stump that leans over an opening in the side of a vessel, with stays at heel and toe.
function sidePicture(label: string): SVGElement {
  return field(`<rect x="-64" y="4" width="128" height="34" fill="#cf8378" stroke="#5b3a34" stroke-width=".8"/><rect x="-64" y="28" width="128" height="6" fill="#ffffff48"/><ellipse cy="12" rx="27" ry="6.5" fill="#7c3b36"/>
    <path d="M-25 8L24 6L62 -34L36 -56Z" fill="#cf8378" stroke="#5b3a34" stroke-width=".8"/><path d="M-52 0H-46V42H-52ZM46 0H52V42H46Z" fill="#METAL" stroke="#2b333b" stroke-width=".6"/>
    <path d="M-30 16L-22 4C-34 -6 -40 -20 -44 -30M24 2L30 16C40 8 50 -2 58 -8" ${kThread}/>`, label);
}

/// Two stumps held together by one thread that runs round them.
function runningPicture(label: string): SVGElement {
  const turns = [-26, -13, 0, 13].map((y) => `<path d="M-9 ${y}L9 ${y + 5}" ${kThread}/><path d="M9 ${y + 5}L-9 ${y + 13}" ${kThread} opacity=".35"/>`).join("");
  return field(`<rect x="-64" y="-32" width="63" height="64" fill="#dcc8b6" stroke="#5b3a34" stroke-width=".8"/><rect x="1" y="-32" width="63" height="64" fill="#dcc8b6" stroke="#5b3a34" stroke-width=".8"/>
    <rect x="-64" y="-27" width="128" height="9" fill="#ffffff48"/>${turns}<path d="M-9 26L9 31C16 34 22 44 20 54" ${kThread}/><path d="M-9 -26C-18 -30 -22 -42 -18 -54" ${kThread}/>`, label);
}

/// Two stumps of a vein: flat, their lumens slits.
function veinPicture(label: string): SVGElement {
  const stump = (end: number) => `<g transform="scale(${end} 1)"><path d="M6 -9C26 -9 34 -17 64 -18V18C34 17 26 9 6 9Z" fill="#8d7fa8" stroke="#4c3f63" stroke-width=".8"/><ellipse cx="6" rx="3" ry="9.5" fill="#4c2f4a" stroke="#8d7fa8" stroke-width="1.6"/><path d="M42 -23H48V23H42Z" fill="#METAL" stroke="#2b333b" stroke-width=".6"/></g>`;
  return field(stump(-1) + stump(1) + `<path d="M-18 -6C-28 -22 -22 -36 -10 -42M-18 -6H14C22 -6 24 -20 25 -27" ${kThread}/>${needle(29, -31, 60, 0.7)}`, label);
}

/// A latex card: a cut with `stitches` across it, or without a cut and with marks round the clock.
function cardPicture(label: string, stitches: number): SVGElement {
  const across = Array.from({ length: stitches }, (_, k) => `<path d="M-9 ${(80 * (k + 0.5)) / stitches - 40}h18" ${kThread}/>`).join("");
  const marks = Array.from({ length: 12 }, (_, k) => `<g transform="rotate(${30 * k})"><path d="M0 -38V-24" stroke="#7a5b12" stroke-width="1.6" stroke-dasharray="2 2"/><circle cy="-38" r="2" fill="#12324a"/><circle cy="-24" r="2" fill="#12324a"/></g>`).join("");
  return field(`<rect x="-46" y="-46" width="92" height="92" rx="3" fill="#e5c96e" stroke="#8a7331" stroke-width=".8"/>` +
    (stitches > 0 ? `<path d="M0 -43V43" stroke="#6b5418" stroke-width="3"/>${across}` : marks + needle(0, 4, 0, 0.8)), label);
}

/// Jaws above small objects on the sheet, or above a mark to hold the tip at.
function tipPicture(label: string, objects: boolean): SVGElement {
  const below = objects ? `<circle cx="-24" cy="22" r="9" fill="#POST" stroke="#6d5a46"/><circle cx="2" cy="26" r="9" fill="#POST" stroke="#6d5a46"/><circle cx="28" cy="20" r="9" fill="#POST" stroke="#6d5a46"/>`
    : `<circle cy="18" r="14" fill="none" stroke="#12324a" stroke-width="2"/><circle cy="18" r="2.4" fill="#12324a"/>`;
  const x = objects ? 2 : 0, y = objects ? 18 : 16;
  return field(`${below}<g stroke="#2b333b" stroke-width=".6"><path d="M${x - 2} ${y}L${x - 16} -62H${x - 4}Z" fill="#METAL"/><path d="M${x + 2} ${y}L${x + 16} -62H${x + 4}Z" fill="#METAL"/></g>`, label);
}

const kScenes: Record<string, (title: string) => SVGElement> = {
  "knot-throw": (title) => knotPicture("overhand", title, true),
  "knot-two-forceps": (title) => knotPicture("square", title, true, 0.8), // small enough for both instruments
  "vessel-handling": handlingPicture,
  "artery-stitch": (title) => vesselPicture(title, "#cf8378", 0),
  "anastomosis-8": (title) => joinPicture(title, [0, 180], [45, 90, 135, 225, 270, 315]),
  "vessel-stitch": (title) => vesselPicture(title, "#dcc8b6", 0),
  "anastomosis-lapses": lapsesPicture,
  "stitch-throw": (title) => vesselPicture(title, "#dcc8b6", 1),
  "stitch-knot": (title) => vesselPicture(title, "#dcc8b6", 3),
  "artery-knot": (title) => vesselPicture(title, "#cf8378", 3),
  "artery-two-stitches": (title) => joinPicture(title, [90, 270], []),
  "artery-four-stitches": (title) => joinPicture(title, [0, 180], [90, 270]),
  "anastomosis-vein": veinPicture,
  "triangulation-120": (title) => joinPicture(title, [90, 210, 330], [30, 150, 270]),
  "posterior-wall-first": (title) => joinPicture(title, [225, 270, 315], [0, 45, 90, 135, 180]),
  "continuous-suture": runningPicture,
  "end-to-side": sidePicture,
  "card-stitches": (title) => cardPicture(title, 2),
  "ten-stitches": (title) => cardPicture(title, 10),
  "needle-course": (title) => cardPicture(title, 0),
  "needle-loading": (title) => field(needle(0, 8, -20, 1.9), title),
  "grasp-transfer": (title) => tipPicture(title, true),
  "tip-hold": (title) => tipPicture(title, false),
};

/// Picture of a task by the name that the trainer gives.
export function taskPicture(name: string, title: string): SVGElement {
  if (kBlades[name]) return brainPicture(title, kBlades[name]);
  if (kScenes[name]) return kScenes[name](title);
  const knot = /^knot-(.+)$/.exec(name)?.[1];
  if (knot && kThrows[knot]) return knotPicture(knot, title, true);
  return knotPicture("", title, false);
}

/// Icons differ in outline as well as in colour.
export const icon = {
  info: () => svg(`<svg viewBox="0 0 24 24" class="icon" aria-hidden="true"><circle cx="12" cy="12" r="10" fill="none" stroke="currentColor" stroke-width="2"/><path d="M12 11v6M12 7v.5" stroke="currentColor" stroke-width="2.4" stroke-linecap="round"/></svg>`),
  warn: () => svg(`<svg viewBox="0 0 24 24" class="icon" aria-hidden="true"><path d="M12 2.5 22.5 21h-21z" fill="none" stroke="currentColor" stroke-width="2" stroke-linejoin="round"/><path d="M12 9v6M12 17.6v.6" stroke="currentColor" stroke-width="2.4" stroke-linecap="round"/></svg>`),
  danger: () => svg(`<svg viewBox="0 0 24 24" class="icon" aria-hidden="true"><path d="M7.6 1.5h8.8l6.1 6.1v8.8l-6.1 6.1H7.6l-6.1-6.1V7.6z" fill="currentColor"/><path d="M8 8l8 8M16 8l-8 8" stroke="#fff" stroke-width="2.6" stroke-linecap="round"/></svg>`),
  pass: () => svg(`<svg viewBox="0 0 24 24" class="icon" aria-hidden="true"><circle cx="12" cy="12" r="10.5" fill="none" stroke="currentColor" stroke-width="2"/><path d="M6.5 12.5l4 4 7-8" fill="none" stroke="currentColor" stroke-width="2.6" stroke-linecap="round" stroke-linejoin="round"/></svg>`),
  fail: () => svg(`<svg viewBox="0 0 24 24" class="icon" aria-hidden="true"><rect x="2" y="2" width="20" height="20" rx="3" fill="none" stroke="currentColor" stroke-width="2"/><path d="M7.5 7.5l9 9M16.5 7.5l-9 9" stroke="currentColor" stroke-width="2.6" stroke-linecap="round"/></svg>`),
};
