import { listed, measured, quantity, reason } from "@viewer/ui/format";

const event = (time: number, name: string, value = 0) => ({ time, name, value, tool: -1, unit: "N" });

describe("listed events", () => {
  it("tells reports of imprecise steps that follow each other once, with number, end and largest value", () => {
    const list = listed([event(1, "puncture", 5e-4), event(2, "solver-trouble", 1e-4), event(2.5, "overrun"), event(3, "solver-trouble", 4e-4), event(4, "solver-trouble", 2e-4), event(5, "cut", 2e-2),
      event(6, "solver-trouble", 3e-4)]);
    expect(list.map((one) => [one.time, one.name, one.value])).toEqual([[1, "puncture", 5e-4], [2, "solver-trouble", 4e-4], [5, "cut", 2e-2], [6, "solver-trouble", 3e-4]]);
    expect((list[1] as { text?: string }).text).toBe("The simulation was imprecise 3 times until 4.0 s, at most by");
    expect((list[3] as { text?: string }).text).toBeUndefined();
  });

  it("leaves other events alone, also the same twice", () => {
    const list = [event(1, "cut", 1e-2), event(2, "cut", 2e-2)];
    expect(listed(list)).toEqual(list);
  });
});

describe("units", () => {
  it("are written one way, whatever the trainer calls them", () => {
    expect([quantity(20, "um"), quantity(30, "deg"), quantity(1.03, "mmHg.min"), quantity(0.175, "share"), quantity(0.1, "rad")]).toEqual(["20 µm", "30°", "1.03 mmHg min", "17.5 %", "5.73°"]);
    expect(reason("12.5 deg: full points up to 20 um, none from 15 mmHg.min. A degree, an umbrella")).toBe("12.5°: full points up to 20 µm, none from 15 mmHg min. A degree, an umbrella");
  });
  it("of a measured force are those of the reason beside it", () => {
    expect([measured(1.047, "N"), measured(0.11, "N"), measured(25, "mN"), measured(null, "N")]).toEqual(["1.05 N", "0.11 N", "25 mN", "not measured"]);
  });
});
