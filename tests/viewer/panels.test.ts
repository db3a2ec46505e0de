import { clock, eventWords, milliNewton, quantity } from "@viewer/ui/format";
import { barScale, ForcePanel, StepPanel, tensionZone, WarningList } from "@viewer/ui/panels";
import { knotPicture, kThrows, strands, taskPicture } from "@viewer/ui/pictures";
import { chartsOf, labelsThatFit } from "@viewer/ui/plots";
import { kShortcuts } from "@viewer/input/shortcuts";
import type { Frame, Scene } from "@viewer/messages";
import { frameAt as sample, kScene } from "./sample_frames.mjs";

const scene = kScene as Scene, frameAt = sample as (time: number, id: number, duration: number) => Frame;

describe("events", () => {
  it("are told in words", () => {
    expect(eventWords({ name: "goal-done", value: 3 })).toBe("Step 3 done");
    expect(eventWords({ name: "solver-trouble", value: 8e-4 })).toContain("imprecise");
    expect(eventWords({ name: "needle-taken", value: 0.1 })).toBe("Needle taken");
    expect(eventWords({ name: "knot", value: 0, text: "square" })).toBe("square");
  });
});

describe("numbers", () => {
  it("carry their unit", () => {
    expect(milliNewton(0.1234)).toBe("123 mN");
    expect(milliNewton(0.0042)).toBe("4.2 mN");
    expect(quantity(0.0026, "m")).toBe("2.60 mm");
    expect(quantity(null, "N")).toBe("not measured");
    expect(quantity(2, "-")).toBe("2");
    expect(quantity("square", "-")).toBe("square");
  });
  it("show time as minutes and seconds", () => {
    expect(clock(0)).toBe("0:00.0");
    expect(clock(83.27)).toBe("1:23.2");
  });
});

describe("force bars", () => {
  it("tell zones of the thread's strength", () => {
    expect(tensionZone(0.05, 0.15)).toBe("ok");
    expect(tensionZone(0.1, 0.15)).toBe("high");
    expect(tensionZone(0.14, 0.15)).toBe("near-break");
    expect(tensionZone(0.14, 0)).toBe("ok");
  });
  it("have a scale that always holds the value", () => {
    for (const force of [0.01, 0.2, 0.21, 1, 7]) expect(barScale(force)).toBeGreaterThanOrEqual(force);
  });
  it("say the largest tension of the frame in words, not by colour alone", () => {
    const panel = new ForcePanel(scene), frame = { ...frameAt(0, 1, 10), tension: [0.01, 0.14, 0.02] };
    panel.show(frame, 0);
    const meter = panel.element.querySelector(".meter")!;
    expect(meter.getAttribute("aria-valuetext")).toBe("Tension 140 mN · near limit");
    expect(meter.getAttribute("data-zone")).toBe("near-break");
    panel.show({ ...frame, tools: frame.tools.map((tool) => ({ ...tool, input_valid: false })) }, 0);
    expect(panel.element.textContent).toContain("no input");
  });
});

describe("steps", () => {
  it("mark done, current and coming steps with a sign each", () => {
    const panel = new StepPanel("Square knot"), task = { ...frameAt(4, 1, 10).task!, step_index: 1, steps: ["grasp", "loop", "cut"] };
    panel.show(task, 4);
    expect([...panel.element.querySelectorAll(".mark")].map((mark) => mark.textContent)).toEqual(["✓", "▶", "3"]);
    expect(panel.element.querySelector("[aria-current=step]")!.textContent).toContain("Loop");
    expect(panel.element.querySelector(".hint")!.textContent).toBe(task.hint);
  });
});

describe("warnings", () => {
  it("differ by word and outline, and sound once", () => {
    const list = new WarningList(), heard: string[] = [];
    list.onnew = (level) => heard.push(level);
    const three = (["info", "warn", "danger"] as const).map((level) => ({ level, text: `text ${level}`, code: level }));
    list.show(three);
    list.show(three);
    expect(heard).toEqual(["info", "warn", "danger"]);
    const shown = [...list.element.children];
    expect(shown.map((one) => one.querySelector("strong")!.textContent)).toEqual(["Note", "Caution", "Stop"]);
    expect(new Set(shown.map((one) => one.querySelector("svg")!.innerHTML)).size).toBe(3);
    list.show([]);
    expect(list.element.children.length).toBe(0);
    list.show(three.slice(1, 2));
    expect(heard.length).toBe(4);
  });
});

describe("knot pictures", () => {
  /// Sign of each crossing between the strands, row by row from the post: the sense in which a throw turns.
  const senses = (knot: string) => kThrows[knot].map((one) => one.sense);
  it("tell a square knot from a granny", () => {
    expect(senses("square")).toEqual([1, -1]);
    expect(senses("granny")).toEqual([1, 1]);
    expect(knotPicture("square", "s", false).innerHTML).not.toBe(knotPicture("granny", "s", false).innerHTML);
  });
  it("draw two strands that end on both sides of every throw", () => {
    for (const [name, throws] of Object.entries(kThrows)) {
      const [left, right] = strands(throws, 0);
      expect(left[0][0]).toBeLessThan(0);
      expect(right[0][0]).toBeGreaterThan(0);
      const crossings = throws.reduce((sum, one) => sum + one.crossings, 0);
      const swapped = crossings % 2 === 1;
      expect(Math.sign(left[left.length - 1][0]), name).toBe(swapped ? 1 : -1);
    }
  });
});

describe("plots", () => {
  it("put curves of one unit on one axis, scaled to the shown unit, without inventing values", () => {
    const charts = chartsOf([
      { name: "a", title: "A", unit: "N", time: [0, 1], value: [0.1, 0.2] }, { name: "b", title: "B", unit: "N", time: [1, 2], value: [0.3, 0.4] },
      { name: "v", title: "V", unit: "m/s", time: [0], value: [0.5] }]);
    expect(charts.map((chart) => chart.unit)).toEqual(["mN", "mm/s"]);
    expect(charts[0].columns).toEqual([[0, 1, 2], [100, 200, null], [null, 300, 400]]);
  });
  it("give curves that another would flatten a chart of their own, but not those at rest", () => {
    const curve = (name: string, value: number) => ({ name, title: name, unit: "N", time: [0, 1], value: [0, value] });
    const charts = chartsOf([curve("squeeze", 3), curve("pull", 0.03), curve("tension", -0.035), curve("idle", 1e-9), curve("other", 0.16)]);
    expect(charts.map((chart) => [chart.names, chart.smaller])).toEqual([[["squeeze", "idle", "other"], false], [["pull", "tension"], true]]);
  });
  it("label only events whose words have room", () => {
    const width = (text: string) => 10 * text.length;
    expect(labelsThatFit([{ x: 0, text: "imprecise" }, { x: 80, text: "cut" }, { x: 95, text: "cut" }, { x: 190, text: "knot" }], width, 200)).toEqual(["imprecise", "", "cut", ""]);
  });
});

it("no key is listed twice for the same place", () => {
  for (const group of kShortcuts) {
    const keys = group.shortcuts.map((one) => one.keys);
    expect(new Set(keys).size).toBe(keys.length);
  }
});

it("tasks that differ in what is done have pictures that differ", () => {
  const tasks = ["vessel-handling", "artery-stitch", "anastomosis-8", "vessel-stitch", "anastomosis-lapses", "stitch-throw", "stitch-knot", "artery-knot", "artery-two-stitches", "artery-four-stitches", "anastomosis-vein", "triangulation-120", "posterior-wall-first", "continuous-suture", "end-to-side", "card-stitches", "ten-stitches", "needle-course", "needle-loading", "grasp-transfer", "tip-hold", "trace",
    "press-to-target", "sylvian-opening", "knot-throw", "knot-square", "knot-two-forceps", "knot-surgeons"];
  const drawn = tasks.map((task) => taskPicture(task, "").outerHTML.replace(/field\d+/g, ""));
  expect(new Set(drawn).size).toBe(tasks.length);
});

it("tells what tissue and needle do to a tip where there is tissue, else the thread's pull alone", () => {
  const told = (of: typeof scene) => {
    const panel = new ForcePanel(of), frame = frameAt(0, 1, 10);
    panel.show({ ...frame, tools: frame.tools.map((one) => ({ ...one, force: [0.003, 0, 0.004], thread_force: 0.002 })) }, null);
    return [...panel.element.querySelectorAll<HTMLElement>('[aria-valuetext^="Pull"]')].map((one) => one.getAttribute("aria-valuenow"));
  };
  expect(told(scene)[0]).toBe("2.0");
  expect(told({ ...scene, tissue: { name: "card" } } as unknown as typeof scene)[0]).toBe("5.0");
});
