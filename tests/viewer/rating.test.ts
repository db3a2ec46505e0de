import { RatePage } from "@viewer/ui/rate_page";
import { ResultPage } from "@viewer/ui/result_page";
import type { App } from "@viewer/app";
import type { Result, Scale } from "@viewer/messages";
import type { Rated } from "@viewer/net/api";
import { resultOf } from "./sample_frames.mjs";

const item = (name: string, points: string[], estimate: number | null) => ({ name, title: `Title of ${name}`, points, estimate, value: null, unit: "-", why: `why ${name}` });
const mars: Scale = { name: "mars10", title: "MARS10", source: "S", label: "estimates", most: 2, items: [item("closure", ["bad", "fair", "good"], 1), item("knots", ["bad", "fair", "good"], null)] };
const lapses: Scale = { name: "lapse-index", title: "Lapse index", source: "S", label: "estimates", most: 1, better: "fewer", items: ["back-wall", "oblique"].map((name) => item(name, ["absent", "present"], name === "oblique" ? 1 : 0)) };
const estimates: Record<string, Record<string, number>> = { mars10: { closure: 1 }, "lapse-index": { "back-wall": 0, oblique: 1 } };

let scales: Scale[] = [], stored: Rated[] = [];
const give = (scale: string, rater: string, marks: Record<string, number>) => {
  stored = stored.filter((one) => one.scale !== scale || one.rater !== rater);
  stored.push({ scale, rater, stored: "2026-11-22T01:00:00Z", marks });
};
beforeEach(() => {
  scales = [mars, lapses];
  stored = [];
  globalThis.fetch = (async (path: string, init?: { method?: string; body?: string }) => {
    if (!path.startsWith("/api/ratings/")) return new Response("", { status: 404 });
    if (init?.method === "POST") {
      const { rater, scale, marks } = JSON.parse(init.body!);
      if (rater === "bad") return new Response(JSON.stringify({ refused: "rater: found bad, expected a code" }));
      give(scale, rater, marks);
      give(scale, "simulator", estimates[scale]);
    }
    return new Response(JSON.stringify({ session: "s1", task: "t", title: "Join", scales, ratings: stored, trouble: "" }));
  }) as unknown as typeof fetch;
});

const settled = () => new Promise((done) => setTimeout(done, 20));
const opened = async () => {
  const page = new RatePage({} as App, "s1");
  document.body.replaceChildren(page.element);
  await settled();
  return page.element;
};
const panel = (page: HTMLElement, scale: string) => page.querySelector(`[data-scale=${scale}]`) as HTMLElement;
const type = (page: HTMLElement, code: string) => {
  const input = page.querySelector("input[name=rater]") as HTMLInputElement;
  input.value = code;
  input.dispatchEvent(new Event("change"));
};
const choose = (form: HTMLElement, name: string, points: number) => { (form.querySelector(`input[name="item-${name}"][value="${points}"]`) as HTMLInputElement).checked = true; };
const store = async (form: HTMLElement) => { form.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true })); await settled(); };
const rows = (form: HTMLElement) => [...form.querySelectorAll(".given tbody tr")].map((row) => [...row.children].map((cell) => cell.textContent));

describe("raters' forms", () => {
  it("hide the estimates until marks are given, then show both", async () => {
    const page = await opened(), form = panel(page, "mars10");
    expect(page.textContent).not.toContain("why closure");
    type(page, "R1");
    for (const name of ["closure", "knots"]) choose(form, name, 2);
    await store(form);
    expect(stored[0]).toMatchObject({ scale: "mars10", rater: "R1", marks: { closure: 2, knots: 2 } });
    expect(rows(form)[0].slice(0, 4)).toEqual(["Title of closure", "2", "1", "why closure"]);
    expect(rows(form)[1].slice(0, 3)).toEqual(["Title of knots", "2", "–"]);
    expect(rows(form)[2].slice(0, 3)).toEqual(["Sum", "4", "–"]);
  });
  it("are stored one by one: one shows nothing of the other, whose marks stay as they are", async () => {
    const page = await opened(), [first, second] = [panel(page, "mars10"), panel(page, "lapse-index")];
    expect(second.textContent).toContain("Fewer points are better");
    expect(first.textContent).toContain("More points are better");
    type(page, "R1");
    choose(second, "oblique", 0);
    for (const name of ["closure", "knots"]) choose(first, name, 1);
    await store(first);
    expect(rows(second)).toEqual([]);
    expect(second.textContent).not.toContain("why oblique");
    expect((second.querySelector('input[name="item-oblique"][value="0"]') as HTMLInputElement).checked).toBe(true);
    choose(second, "back-wall", 0);
    await store(second);
    expect(stored.find((one) => one.scale === "lapse-index" && one.rater === "R1")!.marks).toEqual({ "back-wall": 0, oblique: 0 });
    expect(rows(second).map((row) => row.slice(0, 3))).toEqual([["Title of back-wall", "0", "0"], ["Title of oblique", "0", "1"], ["Sum", "0", "1"]]);
  });
  it("show another rater's marks only to who has given theirs", async () => {
    give("mars10", "R1", { closure: 2, knots: 0 });
    give("mars10", "simulator", estimates.mars10);
    const page = await opened(), form = panel(page, "mars10");
    expect(rows(form)).toEqual([]);
    expect(form.textContent).toContain("1 rater has marked this");
    expect(panel(page, "lapse-index").textContent).toContain("Nobody has marked this yet");
    type(page, "R2");
    expect(rows(form)).toEqual([]);
    type(page, "R1");
    expect(rows(form)[0].slice(0, 3)).toEqual(["Title of closure", "2", "1"]);
  });
  it("are filled in by the keys of numbers, but not by keys held with Ctrl or beyond the scale", async () => {
    const page = await opened(), form = panel(page, "lapse-index"), question = form.querySelector("[data-item=oblique]")!;
    const chosen = () => question.querySelector<HTMLInputElement>("input:checked")?.value;
    for (const init of [{ key: "2" }, { key: "1", ctrlKey: true }, { key: "x" }]) question.dispatchEvent(new KeyboardEvent("keydown", init));
    expect(chosen()).toBeUndefined();
    question.dispatchEvent(new KeyboardEvent("keydown", { key: "1" }));
    expect(chosen()).toBe("1");
    expect(document.activeElement).toBe(question.querySelector("input[value='1']"));
    question.dispatchEvent(new KeyboardEvent("keydown", { key: "0" }));
    expect(chosen()).toBe("0");
    expect(form.querySelectorAll("input:checked").length).toBe(1);
  });
  it("say what was refused, each for itself, and that a code is missing", async () => {
    const page = await opened(), form = panel(page, "lapse-index");
    await store(form);
    expect(form.querySelector("[role=alert]")!.textContent).toContain("code is missing");
    expect(stored).toEqual([]);
    type(page, "R 1");
    await store(form);
    expect(form.querySelector("[role=alert]")!.textContent).toContain("letters, digits, - and _ only");
    type(page, "bad");
    choose(form, "oblique", 0);
    await store(form);
    expect(form.querySelector("[role=alert]")!.textContent).toBe("Every item needs a mark. Still without one: Title of back-wall.");
    expect(form.querySelector("form")!.noValidate, "our words instead of the browser's").toBe(true);
    choose(form, "back-wall", 0);
    await store(form);
    expect(form.querySelector("[role=alert]")!.textContent).toContain("expected a code");
    expect(panel(page, "mars10").querySelector("[role=alert]")!.textContent).toBe("");
  });
  it("explain [P] once it is shown", async () => {
    scales = [{ ...mars, items: [{ ...mars.items[0], why: "Source: [P]" }] }];
    const page = await opened(), note = () => [...page.querySelectorAll("p")].filter((one) => !one.hidden && one.textContent!.includes("not yet confirmed")).length;
    expect(note()).toBe(0);
    type(page, "R1");
    choose(panel(page, "mars10"), "closure", 1);
    await store(panel(page, "mars10"));
    expect(note()).toBe(1);
  });
  it("are one where the recording has one scale, and none where it has none", async () => {
    scales = [mars];
    expect((await opened()).querySelectorAll("form").length).toBe(1);
    scales = [];
    const page = await opened();
    expect(page.querySelectorAll("form").length).toBe(0);
    expect(page.textContent).toContain("no rating scale");
  });
});

it("a result shows the estimates of every scale, says which way is better, and leads to the forms once", () => {
  const result = { ...(resultOf("s 1", 30) as unknown as Result), scales };
  const page = new ResultPage({ result, session: null } as unknown as App, "");
  const cards = [...page.element.querySelectorAll(".panel.scale")];
  expect(cards.map((card) => card.querySelector("h2")!.textContent)).toEqual(["MARS10", "Lapse index"]);
  expect(cards[0].textContent).toContain("1 of 2 points of the items that can be estimated; 1 of 2 items are left");
  expect(cards[1].textContent).toContain("1 of 2 points of the items that can be estimated; 0 of 2 items are left to a rater. Fewer points are better");
  expect(page.element.querySelectorAll('a[href="#/rate/s%201"]').length).toBe(1);
});

it("a result explains [P] once, where it shows it", () => {
  const shown = (source: string) => new ResultPage({ result: { ...(resultOf("s 1", 30) as unknown as Result), scales: [{ ...mars, source }] }, session: null } as unknown as App, "").element.querySelectorAll(".proposal").length;
  expect([shown("S"), shown("numbers [P]")]).toEqual([0, 1]);
});
