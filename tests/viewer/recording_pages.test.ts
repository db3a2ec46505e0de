// Pages of one recording in a trainer that tells every browser about every session.
import { MomentsPage } from "@viewer/ui/moments_page";
import { ReplayPage } from "@viewer/ui/replay_page";
import { fakeApp, frame, replayOf, resultFor, scene, state } from "./pages";

const refused = { type: "error" as const, code: "not-in-control", what: "Another browser is in control.", advice: "" };
const lapses = [{ name: "wide-bite", stitch: 0, time: 20, value: 4.6, unit: "thicknesses" }];
let app: ReturnType<typeof fakeApp>, page: ReplayPage | MomentsPage;
const text = () => page.element.textContent!;
const press = (label: string) => [...page.element.querySelectorAll("button")].find((one) => one.textContent === label)!.click();
beforeEach(() => { app = fakeApp(); });
afterEach(() => page.dispose());

describe("a replay", () => {
  const open = () => { page = app.show(new ReplayPage(app.app, "mine")); };
  const opened = () => app.hear(state("loading", "mine"), scene, resultFor("mine"), state("replay", "mine"), replayOf("mine"), frame());

  it("draws nothing of the replay that was open before it", () => {
    open();
    app.hear(scene, resultFor("other"), replayOf("other", 12), state("replay", "other"), frame(12));
    expect(text()).toContain("Opening the recording…");
    expect(page.element.querySelector(".events, .steps")).toBeNull();
    expect(page.element.classList.contains("foreign")).toBe(true);
    opened();
    expect(text()).not.toContain("Opening the recording…");
    expect(page.element.querySelector(".events")).not.toBeNull();
    expect(page.element.classList.contains("foreign")).toBe(false);
  });
  it("that is refused says so over somebody else's task, and takes control", () => {
    open();
    app.hear(scene, state("running", "other", { in_control: false }), frame(), refused);
    expect(text()).toContain("Another browser is in control. Its task ends if you take control.");
    app.sent.length = 0;
    press("Take control");
    expect(app.sent).toEqual([{ type: "take_control" }, { type: "replay_open", session: "mine" }]);
    expect(text()).toContain("Opening the recording…");
    expect(app.dropped, "the notice that somebody else is in control").toEqual(["not-in-control"]);
  });
  it("is watched where another browser has opened the same", () => {
    open();
    app.hear(scene, resultFor("mine"), replayOf("mine"), state("replay", "mine", { in_control: false }), refused, replayOf("mine", 1));
    expect(text()).toContain("Another browser is in control.");
    expect(page.element.querySelector(".events")).not.toBeNull();
    press("Watch");
    expect(text()).not.toContain("Another browser is in control.");
  });
  it("is watched from the first moment by a page that comes to it later", () => {
    app.hear(state("replay", "mine", { in_control: false }), scene, resultFor("mine"), replayOf("mine", 12), frame(12));
    open();
    app.hear(refused);
    expect(page.element.querySelector(".events li")).not.toBeNull();
    expect(text()).toContain("0:12.0 / 0:30.0");
    press("Watch");
    expect(page.element.classList.contains("foreign")).toBe(false);
  });
  it("says when the trainer has gone on to something else", () => {
    open();
    opened();
    app.hear(state("running", "other", { in_control: false }), frame());
    expect(text()).toContain("not open any more");
    expect(page.element.querySelector(".events")).toBeNull();
    app.sent.length = 0;
    press("Open it again");
    expect(app.sent).toEqual([{ type: "replay_open", session: "mine" }]);
    opened();
    expect(page.element.querySelector(".over")!.textContent).toBe("");
  });
  it("lists, marks and jumps to what happened, not to what comes with every step", () => {
    const event = (time: number, name: string) => ({ time, name, tool: -1, value: 0, unit: "s" }), mine = [...Array.from({ length: 20 }, (_, k) => event(k, k % 2 ? "overrun" : "target-error")), event(25, "needle-taken")];
    open();
    app.hear(state("loading", "mine"), scene, resultFor("mine", { events: mine }), state("replay", "mine"), replayOf("mine"), frame());
    expect([...page.element.querySelectorAll(".eventbutton")].map((one) => one.children[1].textContent)).toEqual(["Needle taken"]);
    expect(page.element.querySelectorAll(".marks span").length).toBe(1);
    (page as ReplayPage).onkey(new KeyboardEvent("keydown", { key: "ArrowDown" }));
    expect(app.sent.at(-1)).toEqual({ type: "seek", time: 25 });
  });
  it("ends nothing of another session when it is left", () => {
    open();
    app.hear(state("replay", "other", { in_control: false }));
    app.sent.length = 0;
    page.dispose();
    expect(app.sent).toEqual([]);
  });
});

describe("the moments", () => {
  const open = () => { page = app.show(new MomentsPage(app.app, "mine")); };
  it("of a session with lapses do not say that another has none", () => {
    open();
    app.hear(scene, resultFor("other", { lapses: [] }), replayOf("other"), state("replay", "other"), frame());
    expect(text()).toContain("Opening the recording…");
    app.hear(state("loading", "mine"), scene, resultFor("mine", { lapses }), state("replay", "mine"), replayOf("mine"));
    expect(text()).toContain("lapse 1 of 1");
    expect(app.sent.at(-1)).toEqual({ type: "seek", time: 20 });
  });
  it("tell how far the recording is computed on the way to the next", () => {
    open();
    const bar = () => page.element.querySelector("progress")!;
    expect(bar().hidden).toBe(true);
    app.hear(state("loading", "mine"), scene, resultFor("mine", { lapses }), state("replay", "mine"), { ...replayOf("mine"), ready: 5 });
    expect(bar().hidden).toBe(false);
    expect(bar().value).toBeCloseTo(5 / 20);
    expect(text()).toContain("now at 0:05.0 of 0:20.0");
    app.hear({ ...replayOf("mine", 20), ready: 21 });
    expect(bar().hidden).toBe(true);
  });
  it("say who is in control, and take it", () => {
    open();
    app.hear(scene, state("running", "other", { in_control: false }), refused);
    app.sent.length = 0;
    press("Take control");
    expect(app.sent).toEqual([{ type: "take_control" }, { type: "replay_open", session: "mine" }]);
  });
  it("of a session that was not scored are said to be unknown", () => {
    open();
    app.hear(state("loading", "mine"), scene, state("replay", "mine"), replayOf("mine"));
    expect(text()).toContain("not scored");
  });
});
