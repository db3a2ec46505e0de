// The page of a running task: where Escape leads, and what is shown when no task runs.
import { LivePage } from "@viewer/ui/live_page";
import { fakeApp, frame, replayOf, resultFor, scene, state } from "./pages";

let app: ReturnType<typeof fakeApp>, page: LivePage;
const text = () => page.element.querySelector(".over")!.textContent!;
beforeEach(() => { app = fakeApp(); });
afterEach(() => page.dispose());
const open = () => { page = app.show(new LivePage(app.app)); };

describe("Escape in the field", () => {
  const escape = () => { app.view.surface.focus(); return page.onkey(new KeyboardEvent("keydown", { key: "Escape" })); };

  it("leads to a button that a Space for the grip may press, and from there on to End task", () => {
    open();
    app.hear(state("loading", "s1"), scene, state("running", "s1"));
    expect(escape()).toBe(true);
    expect(document.activeElement!.textContent).toBe("To the field");
    (document.activeElement as HTMLElement).click();
    expect(document.activeElement).toBe(app.view.surface);
    expect(app.sent.some((one) => one.type === "stop")).toBe(false);
    const buttons = [...page.element.querySelectorAll("aside button")].map((one) => one.textContent);
    expect(buttons.indexOf("End task")).toBe(buttons.indexOf("To the field") + 1);
  });
  it("brings hidden panels back, which hold the way out", () => {
    open();
    app.hear(state("loading", "s1"), scene, state("running", "s1"));
    page.element.classList.add("bare");
    escape();
    expect(page.element.classList.contains("bare")).toBe(false);
  });
});

it("moves the instruments with attached forceps that do not know where they are, and says so; others it leaves alone", () => {
  open();
  const hand = (pointer: boolean): string => {
    app.hear(state("loading", "s1", { input: "device", pointer }), scene, state("running", "s1", { input: "device", pointer }), frame());
    return page.element.textContent!;
  };
  expect(hand(true)).toContain("the pointer moves them · Active hand");
  const alone = hand(false);
  expect(alone).toContain("Attached instruments");
  expect(alone).not.toContain("Active hand");
});

describe("without a task", () => {
  it("shows nothing of a replay that was left", () => {
    app.hear(state("replay", "s1"), scene, resultFor("s1"));
    open();
    expect(page.element.querySelector(".steps")).toBeNull();
    app.hear(state("idle", "s1"));
    expect(text()).toContain("No task is running.");
    expect(page.element.querySelectorAll("aside *").length).toBe(0);
    app.hear(replayOf("s1")); // one that was on its way
    expect(app.gone).toEqual([]);
  });
  it("takes the result of a recording that is opened elsewhere for no end of a task, and goes there", () => {
    open();
    app.hear(state("loading", "s2", { in_control: false }), scene, resultFor("s2"));
    app.hear(state("replay", "s2", { in_control: false }), replayOf("s2"));
    expect(text()).not.toContain("Task ended");
    expect(app.gone).toEqual(["#/replay/s2"]);
  });
  it("says why a task did not start, also when the trainer rests then", () => {
    open();
    app.hear(state("loading", null), { type: "error", code: "failed", what: "No file.", advice: "" }, state("idle", null));
    expect(text()).toContain("No file.");
  });
});

it("names the session that a new start of the trainer cut short, with the way to its replay", () => {
  open();
  app.hear(state("loading", "s 1"), scene, state("running", "s 1"), frame(), state("idle", null), state("idle", null, { clients: 2 }));
  expect(text()).toContain("Session s 1 is stored");
  expect(page.element.querySelector(".over a")!.getAttribute("href")).toBe("#/replay/s%201");
  app.hear(state("loading", "s2"), scene, state("running", "s2"), resultFor("s2"), state("ended", "s2"), state("idle", null));
  expect(text()).toContain("No task is running.");
});

describe("a page that is loaded again", () => {
  it("learns from the state after the scene that this is an exam", () => {
    open();
    app.hear({ ...scene, tissue: { name: "card" } } as unknown as typeof scene);
    expect(page.element.querySelector(".steps")).toBeNull();
    app.hear(state("running", "s1", { exam: true }), frame());
    expect(page.element.querySelector(".steps")).not.toBeNull();
    expect(page.element.querySelector(".tissuepanel")).toBeNull();
  });
  it("shows the end that came in the meantime, once", () => {
    open();
    app.hear(scene, resultFor("s1"), state("ended", "s1"));
    expect(text()).toContain("Task ended");
    const link = page.element.querySelector(".over a");
    app.hear(state("ended", "s1", { clients: 2 }), state("ended", "s1", { exam: true }));
    expect(page.element.querySelector(".over a")).toBe(link);
  });
});

it.each([[false, 5], [true, 2]])("in an exam (%s) only the alarm tells of pressure", (exam, n) => {
  open();
  const warnings = ["pressure-alarm", "input-lost", "pressure-yellow", "dose-orange", "release-reminder"].map((code) => ({ level: "danger", text: code, code }));
  app.hear(state("loading", "s1", { exam }), scene, state("running", "s1", { exam }), { ...frame(), task: { ...frame().task, warnings } } as unknown as ReturnType<typeof frame>);
  expect([...page.element.querySelectorAll<HTMLElement>(".warning")].map((one) => one.dataset.code)).toEqual(warnings.slice(0, n).map((one) => one.code));
});
