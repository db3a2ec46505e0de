import { gapScale, joinPlot, stitchAngle } from "@viewer/ui/join_plot";
import type { Leak, Stitch } from "@viewer/messages";

const stitch = (position: number | null): Stitch => ({ time: 1, passes: [0, 1], bite_m: [3e-4, 3e-4], bite_thicknesses: [2, 2], entry_angle_deg: 80, exit_angle_deg: 70, obliquity_deg: 5,
  depth_share: 1, position_m: position, tension_n: 0, peak_force_n: 0, torn_m: 0 });
const edge = (gap: (angle: number) => number) => Array.from({ length: 24 }, (_, k) => ({ angle_deg: 15 * k, gap_m: gap(15 * k) }));
const leak = (gap: (angle: number) => number): Leak => ({ total_ml_per_min: 1, per_sector: [], gap_m: [], open_area_m2: 0, held_mmhg: 100, narrowing: 0, through_ml_per_min: 1, patent: true,
  thread_in_lumen_m: 0, edge_overlap_thicknesses: 0, solver_sound: true, round_m: 3e-3, edge: edge(gap) });

describe("picture of the join", () => {
  it("has round scales, none below 20 µm", () => {
    expect([0, 19, 21, 130, 7000].map(gapScale)).toEqual([20, 20, 50, 200, 5000]);
  });
  it("puts stitches where they lie round the cut", () => {
    expect(stitchAngle(stitch(0.75e-3), 3e-3)).toBeCloseTo(90);
    expect(stitchAngle(stitch(-0.75e-3), 3e-3)).toBeCloseTo(270);
    expect(stitchAngle(stitch(null), 3e-3)).toBeNull();
    expect(stitchAngle(stitch(0), 0)).toBeNull();
  });
  it("draws the gap outward from the edge and tells the widest in words", () => {
    const picture = joinPlot(leak((angle) => (angle === 90 ? 1e-4 : 0)), [stitch(0), stitch(1.5e-3)], [{ name: "wide-bite", stitch: 1, time: 1, value: 3, unit: "thicknesses" }])!;
    expect(picture.getAttribute("aria-label")).toContain("at most 100 µm, at 90°; 2 stitches");
    const points = picture.querySelector(".gap")!.getAttribute("d")!.split("Z")[0].slice(1).split("L").map((one) => one.split(" ").map(Number));
    expect(points.length).toBe(24);
    expect(points[6][0]).toBeCloseTo(0);
    expect(points[6][1]).toBeCloseTo(-114); // full scale, up
    expect(points[0]).toEqual([72, 0]);
    expect([...picture.querySelectorAll("text:not(.quiet)")].map((one) => one.textContent)).toEqual(["1", "2△"]);
  });
  it("is left out where an older result does not tell", () => {
    expect(joinPlot({ ...leak(() => 0), edge: undefined }, [], [])).toBeNull();
    expect(joinPlot({ ...leak(() => 0), round_m: null }, [], [])).toBeNull();
  });
});
