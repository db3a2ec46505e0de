import { both, clampSection, handlingSection, joinSection, lapseValue, replayAt, StitchList, stitchSection, tails } from "@viewer/ui/stitch_panel";
import { cividis } from "@viewer/scene/palette";
import type { Leak, Result, Stitch } from "@viewer/messages";
import { resultOf } from "./sample_frames.mjs";

const stitch = (passes: [number, number], position: number, bites: [number, number | null]): Stitch => ({ time: 12.5, passes, bite_m: [3e-4, 3e-4], bite_thicknesses: bites, entry_angle_deg: 80, exit_angle_deg: 70, obliquity_deg: 5,
  depth_share: 1, position_m: position, tension_n: 2e-3, peak_force_n: 9e-3, torn_m: 0 });
const result = { ...(resultOf("s 1", 30) as unknown as Result), stitches: [stitch([0, 1], 1e-3, [2.4, 2.7]), stitch([2, 3], 0, [4.6, null])], spacings_m: [1e-3],
  lapses: [{ name: "wide-bite", stitch: 1, time: 20, value: 4.6, unit: "thicknesses" }, { name: "back-wall", stitch: 0, time: 11.25, value: 140, unit: "deg", critical: true }], lapse_rules: "Vessel" };

describe("stitches of a result", () => {
  it("stand in order along the cut, each with its bites and lapses and a way to its moment", () => {
    const rows = [...stitchSection(result, "s 1")!.querySelectorAll("tbody tr")].map((row) => [...row.children].map((cell) => cell.textContent));
    expect(rows.map((row) => row[0])).toEqual(["Stitch 2", "Stitch 1"]);
    expect(rows[0][2]).toBe("4.6 / –");
    expect(rows[0][9]).toBe("1.00");
    expect(rows[0][1]).toContain("Wide bite");
    expect(rows[1][1]).toContain("Back wall");
    const links = [...stitchSection(result, "s 1")!.querySelectorAll(".lapses a")].map((link) => link.getAttribute("href"));
    expect(links).toEqual(["#/replay/s%201/20.00/stitch-2", "#/replay/s%201/11.25/stitch-1"]);
    expect(stitchSection(result, "s 1")!.querySelectorAll(".critical").length).toBe(1);
  });
  it("say in which order they stand", () => {
    expect(stitchSection(result, null)!.textContent).toContain("In order along the cut.");
    expect(stitchSection({ ...result, leak: {} as Leak }, null)!.textContent).toContain("In order round the vessel.");
  });
  it("say what the number of each lapse measures", () => {
    const told = (name: string, value: number | null, unit: string) => lapseValue({ name, stitch: 0, time: 1, value, unit });
    expect(told("back-wall", 175, "deg")).toBe("left the lumen 175° round from where it came in");
    expect(told("unequal-spacing", 0.38, "-")).toBe("spaces vary by 38 % of their mean");
    expect(told("loose-knot", 3.43e-3, "m")).toBe("3.43 mm of slack thread in the knot and loop");
    expect(told("loose-knot", 1.5, "thicknesses")).toBe("edges 1.5 wall thicknesses apart");
    expect(told("too-tight", 120, "N/m")).toBe("thread pulls 120 mN for each mm of bite");
    expect(told("partial-thickness", 0.8, "share")).toBe("goes through 80 % of the wall");
    expect([told("something-new", 2.5e-3, "m"), told("back-wall", null, "deg")]).toEqual(["2.50 mm", ""]);
  });
  it("tell the inner bites, the layers and the way to the next, where they are known", () => {
    const told = { ...result, stitches: result.stitches!.map((one, k) => ({ ...one, bites_inner_m: [2.5e-4, k === 0 ? 2.8e-4 : null], depth_layers: ["adventitia", "media"], spacing_m: k === 0 ? null : 1e-3 })) } as Result;
    const [second, first] = [...stitchSection(told, null)!.querySelectorAll("tbody tr")].map((row) => [...row.children].map((cell) => cell.textContent));
    expect([first[3], second[3]]).toEqual(["250 / 280", "250 / –"]);
    expect([first[8], first[9], second[9]]).toEqual(["adventitia, media", "–", "1.00"]);
    const before = [...stitchSection(result, null)!.querySelectorAll("tbody tr td")].map((cell) => cell.textContent);
    expect([before[2], before[7]]).toEqual(["– / –", "–"]);
  });
  it("show the knot of each where it was recognised", () => {
    const tied = { ...result, stitches: [{ ...result.stitches![0], throws: 3, knot: "square", tail_mm: 1.25, short_tail_mm: 0.8 }] };
    const cells = [...stitchSection(tied, null)!.querySelectorAll("tbody td")].map((one) => one.textContent);
    expect(cells.slice(-3)).toEqual(["3", "Square", "1.3 / 0.8"]);
    expect(tails({})).toBe("–");
    expect(tails({ tail_mm: 1.25, short_tail_mm: null })).toBe("1.3");
    const section = clampSection({ upstream_s: 12, downstream_s: null, order_right: true, note: "as asked", pressure_mmhg: [99, 98], leak_ml_per_min: 1, most_leak_ml_per_min: 2, through_ml_per_min: 4.9, lost_ml: 0.1, least_lumen_before_mm2: 0.2, least_lumen_mm2: 0.3 },
      { tests: 1, refilled: 1, stayed_empty: 0, spoiled: 0, refill_s: 0.012, emptied_ml: 3e-4, note: "no proof" })!;
    expect(section.textContent).toContain("left on");
    expect(section.textContent).toContain("12 ms");
    expect(section.textContent).toContain("0.30 µl");
  });
  it("say how the tissue was held, with a warning where the wall was taken through", () => {
    expect(handlingSection({ adventitia: 0, through_wall: 0, slipped: 0, most_pull_n: 0 })).toBeNull();
    expect(handlingSection(undefined)).toBeNull();
    const gentle = handlingSection({ adventitia: 3, through_wall: 0, slipped: 1, most_pull_n: 2.5e-3 })!;
    expect(gentle.textContent).toContain("2.5 mN");
    expect([...gentle.querySelectorAll("dd")].map((one) => one.textContent).slice(0, 3)).toEqual(["3 times", "never", "once"]);
    expect(gentle.querySelector(".alarm")).toBeNull();
    expect(handlingSection({ adventitia: 0, through_wall: 1, slipped: 0, most_pull_n: 0 })!.querySelector(".alarm")!.textContent).toContain("adventitia only");
  });
  it("are not made up where a task has none", () => {
    expect(stitchSection({ ...result, stitches: undefined }, "s")).toBeNull();
    expect(stitchSection({ ...result, stitches: [], lapses: [] }, null)!.textContent).toContain("No stitch was made");
    expect(stitchSection({ ...result, stitches: [], lapses: [] }, null)!.textContent).toContain("No stitch: nothing to look at");
    expect(stitchSection({ ...result, lapses: [] }, null)!.textContent).toContain("No lapse was found");
    expect(both([null, 1], 1)).toBe("– / 1.0");
    expect(replayAt("a/b", null)).toBe("#/replay/a%2Fb/0.00");
  });
  it("are chosen by button or by a way through the tissue, and can be let go again", () => {
    const chosen: number[] = [], list = new StitchList(result, (one) => chosen.push(one));
    const [first, second] = [...list.element.querySelectorAll("button")] as HTMLElement[];
    second.click();
    expect(second.getAttribute("aria-pressed")).toBe("true");
    expect(list.element.textContent).toContain("Wide bite: 4.6 wall thicknesses");
    expect(list.passesOf(1)).toEqual([2, 3]);
    expect(list.stitchOf(1)).toBe(0);
    expect(list.stitchOf(7)).toBe(-1);
    second.click();
    first.click();
    expect(chosen).toEqual([1, -1, 0]);
  });
});

it("the join shows leak, narrowing and doubt", () => {
  const leak: Leak = { total_ml_per_min: 12.3, per_sector: [10, 2.3], gap_m: [5e-5, 1e-5], open_area_m2: 1e-8, held_mmhg: 100, narrowing: 0.2, through_ml_per_min: 9, patent: true, thread_in_lumen_m: 0, edge_overlap_thicknesses: 0, solver_sound: false };
  const text = joinSection(leak)!.textContent!;
  for (const part of ["12.3 ml/min", "Flow on beyond the join9.0 ml/min", "20 %", "patent", "gap 50 µm", "take these numbers with care"]) expect(text).toContain(part);
  expect(joinSection(undefined)).toBeNull();
});

it("the palette gets lighter all the way", () => {
  const light = Array.from({ length: 50 }, (_, k) => { const [r, g, b] = cividis(k / 49); return 0.2126 * r ** 2.2 + 0.7152 * g ** 2.2 + 0.0722 * b ** 2.2; });
  for (let k = 1; k < light.length; ++k) expect(light[k]).toBeGreaterThan(light[k - 1]);
});
