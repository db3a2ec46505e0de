// Numbers for people: always with a unit, never with false precision.

/// Tasks of the laboratory: no thread takes part in them.
export const kLaboratory = ["tip-hold", "trace", "grasp-transfer"];
/// Events that come so often that they hide the others; the recording and the analysis have them.
export const kFrequent = ["overrun", "target-error"];

export function clock(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  const tenths = Math.floor((Math.max(0, seconds) - whole) * 10);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}.${tenths}`;
}

/// [N] -> "123 mN", with three significant figures below 10 mN.
export function milliNewton(newton: number): string {
  const value = newton * 1000;
  if (Math.abs(value) < 0.005) return "0 mN";
  const digits = Math.abs(value) >= 10 ? 0 : Math.abs(value) >= 1 ? 1 : 2;
  return `${value.toFixed(digits)} mN`;
}

const kShown: Record<string, [number, string]> = { N: [1000, "mN"], m: [1000, "mm"], "m/s": [1000, "mm/s"], rad: [180 / Math.PI, "°"],
  um: [1, "µm"], deg: [1, "°"], "mmHg.min": [1, "mmHg min"], share: [100, "%"], thicknesses: [1, "wall thicknesses"] };

/// Factor and unit in which a quantity is shown.
export function shownUnit(unit: string): [number, string] {
  return kShown[unit] ?? [1, unit === "-" ? "" : unit];
}

export function quantity(value: number | string | boolean | null, unit: string): string {
  if (value === null) return "not measured";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value === "string") return unit && unit !== "-" ? `${value} ${unit}` : value;
  const [factor, shown] = shownUnit(unit);
  const scaled = value * factor, size = Math.abs(scaled);
  const text = Number.isInteger(scaled) ? String(scaled) : scaled.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2);
  return shown === "°" ? `${text}°` : shown ? `${text} ${shown}` : text;
}

/// A scored value in the unit of the reason beside it, where a force in newton stays one.
export function measured(value: number | string | boolean | null, unit: string): string {
  return unit === "N" && typeof value === "number" ? `${value.toFixed(2)} N` : quantity(value, unit);
}

/// A reason of the trainer with its units as they are written elsewhere: "12 deg" -> "12°".
export function reason(text: string): string {
  return text.replace(/mmHg\.min\b/g, "mmHg min").replace(/(\d) um\b/g, "$1 µm").replace(/(\d) deg\b/g, "$1°");
}

export const kProposal = "[P]: our own proposal, not yet confirmed by raters.";

export function day(iso: string): string {
  const date = new Date(iso);
  if (Number.isNaN(date.getTime())) return iso;
  return date.toLocaleString(undefined, { year: "numeric", month: "short", day: "numeric", hour: "2-digit", minute: "2-digit" });
}

/// Events whose name says too little.
const kEventTexts: Record<string, string> = {
  "blade-changed": "Blade changed",
  "blade-change-refused": "Blade not changed: lift it clear of the tissue and free it from its arm first",
  "suture-fresh": "A fresh suture lies ready",
  "suture-none-left": "No fresh suture is left",
  "suture-held": "No fresh suture: let go of needle and thread first",
  "suture-in-tissue": "No fresh suture: the needle's thread still runs through the tissue; cut both ends first",
  "suture-no-room": "No fresh suture: there is too much thread in the field",
  "solver-trouble": "The simulation was imprecise for a moment",
  "suture-in-the-way": "No fresh suture: clear the place where the first one lay",
};

/// "thread-overload" -> "Thread overload"
export function words(name: string): string {
  if (kEventTexts[name]) return kEventTexts[name];
  if (name === "sparc" || name === "ldlj") return name.toUpperCase();
  const text = name.replace(/[-_]+/g, " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/// What happened, as it is told to people.
export function eventWords(event: { name: string; value: number; text?: string }): string {
  if (event.text) return event.text;
  return event.name === "goal-done" ? `Step ${event.value} done` : words(event.name);
}

/// Events as they are listed: what comes with every step is left out, reports of an imprecise step that follow each other are one, with their number and the largest value.
export function listed<E extends { name: string; time: number; value: number; text?: string }>(events: readonly E[]): E[] {
  const list: E[] = [];
  let run = 0;
  for (const event of events) {
    if (kFrequent.includes(event.name)) continue;
    const last = list[list.length - 1];
    run = event.name === "solver-trouble" && last?.name === event.name ? run + 1 : 1;
    if (run === 1) list.push(event);
    else list[list.length - 1] = { ...last, value: Math.max(last.value, event.value), text: `The simulation was imprecise ${run} times until ${event.time.toFixed(1)} s, at most by` };
  }
  return list;
}

export const kKnotTitles: Record<string, string> = {
  square: "Square knot", granny: "Granny knot", surgeons: "Surgeon's knot", triple: "Triple knot (1=1=1)", overhand: "Overhand knot",
  "half-hitches": "Half hitches (slipped)", unknot: "No knot", other: "Another knot",
};
