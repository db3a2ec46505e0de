// What was found of stitches, lapses and the join: a table for the result, a list of buttons beside the field of a replay.
import type { Clamps, Handling, Lapse, Leak, MilkingTest, PatencyFactor, Result, Stitch } from "../messages";
import { h } from "./dom";
import { quantity, words } from "./format";
import { joinPlot } from "./join_plot";
import { icon } from "./pictures";

const kCompass = 8; // sectors are counted from where the vessel's angle is zero

/// "2.4 / 2.7": both sides of a stitch; a dash where there was no second side.
export function both(values: readonly (number | null)[], digits: number): string {
  return values.map((value) => (value === null ? "–" : value.toFixed(digits))).join(" / ");
}

function cell(value: number | null | undefined, factor: number, digits: number): string {
  if (value === null || value === undefined) return "–";
  const text = (factor * value).toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text; // no "-0.0"
}

/// "1.2 / 0.9": the cut ends of a knot; a dash where there is none.
export function tails(stitch: Pick<Stitch, "tail_mm" | "short_tail_mm">): string {
  const { tail_mm: longer, short_tail_mm: shorter } = stitch;
  if (longer === null || longer === undefined) return "–";
  return both(shorter === null || shorter === undefined ? [longer] : [longer, shorter], 1);
}

/// "310 / 290": bites where the needle left the first side and came into the second. Older results do not tell.
const inner = (stitch: Stitch): string => both((stitch.bites_inner_m ?? [null, null]).map((value) => (value === null ? null : 1e6 * value)), 0);
const layers = (stitch: Stitch): string => (stitch.depth_layers?.length ? stitch.depth_layers.join(", ") : "–");

/// What the value of a lapse measures (#: the value); "name unit" where a lapse is found by more than one.
const kLapseTexts: Record<string, string> = {
  "oblique": "turned by # from straight across the cut", "wide-bite": "# wide", "partial-thickness": "goes through # of the wall", "wall-tear": "torn by #",
  "too-tight": "thread pulls # of bite", "loose-knot m": "# of slack thread in the knot and loop", "loose-knot thicknesses": "edges # apart", "disrupted-line": "edges # apart up to the next stitch",
  "unequal-spacing": "spaces vary by # of their mean", "back-wall": "left the lumen # round from where it came in", "thread-in-lumen": "# of thread in the lumen", "edge-overlap": "edges overlap by #",
};

function lapseNumber({ name, value, unit }: Lapse): string {
  if (value === null) return "";
  if (unit === "thicknesses") return `${value.toFixed(1)} wall thicknesses`;
  if (unit === "deg") return `${value.toFixed(0)}°`;
  if (unit === "share" || name === "unequal-spacing") return `${(100 * value).toFixed(0)} %`;
  return unit === "N/m" ? `${value.toFixed(0)} mN for each mm` : quantity(value, unit);
}

export function lapseValue(lapse: Lapse): string {
  const number = lapseNumber(lapse), text = kLapseTexts[`${lapse.name} ${lapse.unit}`] ?? kLapseTexts[lapse.name];
  return number && text ? text.replace("#", number) : number;
}

export function ofStitch(lapses: readonly Lapse[] | undefined, stitch: number): Lapse[] {
  return (lapses ?? []).filter((lapse) => lapse.stitch === stitch);
}

/// Where a replay shows stitch `k`, or a moment.
export function replayAt(id: string, time: number | null, stitch = -1): string {
  return `#/replay/${encodeURIComponent(id)}/${(time ?? 0).toFixed(2)}${stitch >= 0 ? `/stitch-${stitch + 1}` : ""}`;
}

const kColumns: [string, string][] = [["Stitch", ""], ["Lapses", ""], ["Bite", "both sides, wall thicknesses"], ["Inside", "µm, bites where it left and came in"], ["Entry", "°, of the needle to the surface"], ["Exit", "°, of the needle to the surface"], ["Oblique", "° to the axis"],
  ["Depth", "% of the wall"], ["Layers", "of the thinner side"], ["Next", "mm along the cut"], ["Tension", "mN, left in the thread"], ["Peak", "mN, largest pull on the wall"], ["Torn", "µm"], ["Throws", "of the knot"], ["Knot", ""], ["Tail", "mm, cut ends"]];

function row(stitch: Stitch, k: number, next: number | null | undefined, lapses: Lapse[], id: string | null): HTMLElement {
  const name = `Stitch ${k + 1}`;
  const found = lapses.length > 0 ? [icon.warn(), " ", lapses.map((one) => words(one.name)).join(", ")] : ["none"];
  const numbers = [both(stitch.bite_thicknesses, 1), inner(stitch), cell(stitch.entry_angle_deg, 1, 0), cell(stitch.exit_angle_deg, 1, 0), cell(stitch.obliquity_deg, 1, 0), cell(stitch.depth_share, 100, 0), layers(stitch),
    cell(next, 1000, 2), cell(stitch.tension_n, 1000, 1), cell(stitch.peak_force_n, 1000, 1), cell(stitch.torn_m, 1e6, 0),
    cell(stitch.throws, 1, 0), stitch.knot ? words(stitch.knot) : "–", tails(stitch)];
  return h("tr", { "data-stitch": k }, h("th", { scope: "row" }, id ? h("a", { href: replayAt(id, stitch.time, k), title: "Show this stitch in the replay" }, name) : name),
    h("td", { class: lapses.length > 0 ? "alarm" : "quiet" }, ...found), ...numbers.map((text) => h("td", { class: "number" }, text)));
}

/// In the order round the cut, so that "next" is the neighbour.
function table(result: Result, stitches: readonly Stitch[], id: string | null): HTMLElement {
  const order = stitches.map((stitch, k) => ({ stitch, k })).sort((a, b) => (a.stitch.position_m ?? 0) - (b.stitch.position_m ?? 0));
  const rows = order.map(({ stitch, k }, at) => row(stitch, k, stitch.spacing_m === undefined ? result.spacings_m?.[at] : stitch.spacing_m, ofStitch(result.lapses, k), id));
  return h("table", { class: "stitches" }, h("thead", {}, h("tr", {}, ...kColumns.map(([name, unit]) => h("th", { scope: "col" }, name, unit ? h("span", { class: "unit" }, unit) : null)))), h("tbody", {}, ...rows));
}

function lapseList(lapses: readonly Lapse[], stitches: number, id: string | null): HTMLElement {
  if (lapses.length === 0 && stitches === 0) return h("p", {}, icon.info(), " No stitch: nothing to look at.");
  if (lapses.length === 0) return h("p", {}, icon.pass(), " No lapse was found.");
  return h("ul", { class: "lapses" }, ...lapses.map((lapse) => {
    const critical = lapse.critical === true, where = lapse.stitch < 0 ? "the whole line" : `stitch ${lapse.stitch + 1}`;
    const text = [h("strong", {}, words(lapse.name)), critical ? h("span", { class: "tag critical" }, "critical") : null, h("span", {}, `${where}: ${lapseValue(lapse)}`)];
    const time = lapse.time === null ? "" : `${lapse.time.toFixed(1)} s`;
    return h("li", { "data-lapse": lapse.name }, icon.warn(), ...text, id && time ? h("a", { class: "button", href: replayAt(id, lapse.time, lapse.stitch) }, `Show the moment (${time})`) : h("span", { class: "quiet" }, time));
  }));
}

/// Stitches and lapses of a result; nothing where the task has none.
export function stitchSection(result: Result, id: string | null): HTMLElement | null {
  const { stitches, lapses } = result;
  if (!stitches) return null;
  return h("section", { class: "panel stitchpanel", "aria-labelledby": "stitches-title" }, h("h2", { id: "stitches-title" }, "Stitch by stitch"),
    ...(stitches.length > 0 ? [h("p", { class: "quiet" }, result.leak ? "In order round the vessel." : "In order along the cut."), h("div", { class: "long wide", tabindex: 0, role: "group", "aria-labelledby": "stitches-title" }, table(result, stitches, id))] : [h("p", { class: "quiet" }, "No stitch was made.")]),
    h("h2", {}, "Lapses"), lapseList(lapses ?? [], stitches.length, id), id && (lapses ?? []).length > 0 ? h("p", {}, h("a", { class: "button", href: `#/moments/${encodeURIComponent(id)}` }, "Pictures of the moments")) : null, h("p", { class: "quiet" }, `By the rules of: ${result.lapse_rules ?? "–"}. All marks are estimates of the simulator.`));
}

/// Leak by sector as bars, with narrowing and flow.
export function joinSection(leak: Leak | undefined, stitches: readonly Stitch[] = [], lapses: readonly Lapse[] = []): HTMLElement | null {
  if (!leak) return null;
  const most = Math.max(1e-9, ...leak.per_sector.map((value) => value ?? 0));
  const bars = leak.per_sector.map((value, k) => h("li", {}, h("span", { class: "sector" }, `${Math.round((360 * k) / Math.max(kCompass, leak.per_sector.length))}°`),
    h("span", { class: "track" }, h("span", { class: "fill", style: `transform:scaleX(${((value ?? 0) / most).toFixed(3)})` })), h("span", { class: "number" }, `${cell(value, 1, 1)} ml/min, gap ${cell(leak.gap_m[k], 1e6, 0)} µm`)));
  const picture = joinPlot(leak, stitches, lapses);
  const narrow = leak.narrowing === null ? "not measured" : `${(100 * leak.narrowing).toFixed(0)} %`;
  return h("section", { class: "panel joinpanel", "aria-labelledby": "join-title" }, h("h2", { id: "join-title" }, `Clamps off, held at ${cell(leak.held_mmhg, 1, 0)} mmHg`),
    h("dl", { class: "facts" }, h("dt", {}, "Leak"), h("dd", {}, `${cell(leak.total_ml_per_min, 1, 1)} ml/min`), h("dt", {}, "Narrowing"), h("dd", {}, narrow),
      h("dt", {}, "Flow on beyond the join"), h("dd", {}, `${cell(leak.through_ml_per_min, 1, 1)} ml/min`), h("dt", {}, "Lumen"), h("dd", {}, leak.patent ? "patent" : "not patent"),
      h("dt", {}, "Thread in the lumen"), h("dd", {}, `${cell(leak.thread_in_lumen_m, 1000, 2)} mm`), h("dt", {}, "Edges overlap or rolled in"), h("dd", {}, `${cell(leak.edge_overlap_thicknesses, 1, 1)} wall thicknesses`)),
    picture ? h("h3", {}, "Gap and stitches round the cut") : null, picture, h("h3", {}, "Leak round the cut"), h("ul", { class: "sectors" }, ...bars), leak.solver_sound ? null : h("p", { class: "alarm" }, "The wall solver had trouble: take these numbers with care."));
}

/// Clamps as they were taken off, and the milking test: what flowed, and what a refill does not show.
export function clampSection(clamps: Clamps | undefined, milking: MilkingTest | undefined): HTMLElement | null {
  if (!clamps && !milking) return null;
  const list = (facts: [string, string][]) => h("dl", { class: "facts" }, ...facts.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
  const when = (time: number | null) => (time === null ? "left on" : `off at ${time.toFixed(1)} s`);
  return h("section", { class: "panel clamppanel", "aria-labelledby": "clamps-title" }, h("h2", { id: "clamps-title" }, "Clamps taken off by hand"),
    clamps ? list([["Upstream", when(clamps.upstream_s)], ["Downstream", when(clamps.downstream_s)], ["Pressure in the stumps", `${both(clamps.pressure_mmhg, 0)} mmHg`],
      ["Leak at the end, most", `${cell(clamps.leak_ml_per_min, 1, 1)}, ${cell(clamps.most_leak_ml_per_min, 1, 1)} ml/min`], ["Flow on through the vessel (below zero: back from collaterals)", `${cell(clamps.through_ml_per_min, 1, 2)} ml/min`],
      ["Blood lost", `${cell(clamps.lost_ml, 1, 2)} ml`], ["Narrowest lumen before, at the end", `${cell(clamps.least_lumen_before_mm2, 1, 3)}, ${cell(clamps.least_lumen_mm2, 1, 3)} mm²`]]) : null,
    clamps ? h("p", { class: clamps.order_right ? "quiet" : "alarm" }, clamps.order_right ? icon.pass() : icon.warn(), ` ${clamps.note}`) : null,
    milking ? h("h3", {}, "Milking test") : null,
    milking ? list([["Refilled", `${milking.refilled} of ${milking.tests}`], ["Time of the last refill", milking.refill_s === null ? "–" : `${cell(milking.refill_s, 1000, 0)} ms`],
      ["Emptied", milking.emptied_ml === null ? "–" : `${cell(milking.emptied_ml, 1000, 2)} µl`], ["Spoiled (the further forceps let go)", `${milking.spoiled}`]]) : null,
    milking ? h("p", { class: "quiet" }, milking.note) : null);
}

const times = (n: number): string => (n === 0 ? "never" : n === 1 ? "once" : `${n} times`);

/// How tissue was held with instruments; nothing where it never was.
export function handlingSection(handling: Handling | undefined): HTMLElement | null {
  if (!handling || handling.adventitia + handling.through_wall === 0) return null;
  const harmed = handling.through_wall > 0;
  return h("section", { class: "panel handlingpanel", "aria-labelledby": "handling-title" }, h("h2", { id: "handling-title" }, "Tissue held with instruments"),
    h("dl", { class: "facts" }, h("dt", {}, "By its adventitia"), h("dd", {}, times(handling.adventitia)), h("dt", {}, "Through its thickness"), h("dd", {}, times(handling.through_wall)),
      h("dt", {}, "Slipped from between the pads"), h("dd", {}, times(handling.slipped)), h("dt", {}, "Largest pull"), h("dd", {}, `${cell(handling.most_pull_n, 1000, 1)} mN`)),
    h("p", { class: harmed ? "alarm" : "quiet" }, harmed ? icon.warn() : icon.pass(), harmed ? " A wall held through its thickness is harmed inside: take the adventitia only, or press with open tips." : " Never through its thickness: the intima was left alone."));
}

/// What raises the risk of a thrombus: factors with their source, no sum and no diagnosis.
export function factorSection(factors: readonly PatencyFactor[] | undefined): HTMLElement | null {
  if (!factors || factors.length === 0) return null;
  const rows = factors.map((one) => h("tr", {}, h("th", { scope: "row" }, one.title), h("td", { class: "number" }, one.unit === "-" ? cell(one.value, 1, 0) : `${cell(one.value, 1, 1)} ${one.unit === "thicknesses" ? "wall thicknesses" : one.unit}`),
    h("td", { class: one.raised ? "alarm" : "quiet" }, one.raised ? icon.warn() : null, one.raised ? " raised" : "not raised"), h("td", { class: "quiet" }, one.source)));
  return h("section", { class: "panel factors scale", "aria-labelledby": "factors-title" }, h("h2", { id: "factors-title" }, "Risk of a thrombus: factors"), h("p", { class: "quiet" }, "Each by itself, as the literature has it. This is no diagnosis, and the factors are not added up."),
    h("table", {}, h("thead", {}, h("tr", {}, ...["Factor", "Here", "", "Known from"].map((name) => h("th", { scope: "col" }, name)))), h("tbody", {}, ...rows)));
}

/// Buttons beside the field of a replay: one for each stitch. Chosen here or in the field.
export class StitchList {
  readonly element: HTMLElement;
  private readonly buttons: HTMLElement[];
  private readonly facts = h("div", { class: "stitchfacts", role: "status", "aria-live": "polite" });
  chosen = -1;

  /// `onchoose`: the stitch, or -1 for none, and whether to go to its time.
  constructor(private readonly result: Result, private readonly onchoose: (stitch: number, go: boolean) => void) {
    const stitches = result.stitches ?? [];
    this.buttons = stitches.map((_, k) => h("button", { class: "segment", "aria-pressed": "false", "data-stitch": k, onclick: () => this.choose(this.chosen === k ? -1 : k, true) },
      `${k + 1}`, ofStitch(result.lapses, k).length > 0 ? h("span", { title: "has lapses" }, " △") : null));
    this.element = h("section", { class: "panel stitchlist", "aria-label": "Stitches" }, h("h2", {}, "Stitches"),
      stitches.length > 0 ? h("div", { class: "buttons", role: "group", "aria-label": "Choose a stitch" }, ...this.buttons) : h("p", { class: "quiet" }, "No stitch was made."), this.facts);
  }

  /// The stitch that a way through the tissue belongs to, -1: none.
  stitchOf(pass: number): number { return (this.result.stitches ?? []).findIndex((one) => one.passes?.includes(pass)); }
  passesOf(stitch: number): number[] { return (this.result.stitches?.[stitch]?.passes ?? []).filter((pass) => pass >= 0); }

  choose(stitch: number, go: boolean): void {
    const one = this.result.stitches?.[stitch];
    this.chosen = one ? stitch : -1;
    this.buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(k === this.chosen)));
    this.facts.replaceChildren();
    if (one) {
      const facts: [string, string][] = [["Bites", `${both(one.bite_thicknesses, 1)} wall thicknesses`], ["Inside", `${inner(one)} µm`], ["Entry, exit", `${cell(one.entry_angle_deg, 1, 0)}°, ${cell(one.exit_angle_deg, 1, 0)}°`],
        ["Oblique", `${cell(one.obliquity_deg, 1, 0)}°`], ["Depth", `${cell(one.depth_share, 100, 0)} % of the wall`], ["Layers", layers(one)], ["Next", `${cell(one.spacing_m, 1000, 2)} mm`], ["Tension left", `${cell(one.tension_n, 1000, 1)} mN`], ["Torn", `${cell(one.torn_m, 1e6, 0)} µm`],
        ["Knot", one.knot ? `${words(one.knot)}, ${cell(one.throws, 1, 0)} throws, tails ${tails(one)} mm` : "–"]];
      const lapses = ofStitch(this.result.lapses, this.chosen);
      this.facts.append(h("h3", {}, `Stitch ${stitch + 1}`), h("dl", { class: "facts" }, ...facts.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
        ...lapses.map((lapse) => h("p", { class: "alarm" }, icon.warn(), ` ${words(lapse.name)}: ${lapseValue(lapse)}`)));
    }
    this.onchoose(this.chosen, go);
  }
}
