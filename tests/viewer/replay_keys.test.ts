// Keys in a replay: they seek, unless the control in focus does something of its own with them.
import { ReplayPage } from "@viewer/ui/replay_page";
import { focusUses } from "@viewer/ui/microscope_keys";
import type { App } from "@viewer/app";

const stage = { floorHeight: 0 }, quality = { current: { name: "high" }, automatic: false, software: false, choose: () => {} };
const zooms: number[] = [];
const view = () => ({
  element: document.createElement("div"), surface: document.createElement("div"), reticleShown: true, onoptics: () => {}, onclick: () => {},
  microscope: { optics: { magnification: 8, focus: 0, eyeDistance: 22 }, stage, stereo: "mono", quality, rendererName: "" },
  start: () => {}, stop: () => {}, mark: () => {}, zoom: (notches: number) => { zooms.push(notches); },
});

describe("keys in a replay", () => {
  let page: ReplayPage, sent: { type: string; time?: number }[];
  const app = { microscope: view, online: false, hello: null, session: null, replay: { session: "s1", time: 10, duration: 30, ready: 30, playing: false }, send: (message: { type: string }) => { sent.push(message); return true; } };
  beforeEach(() => {
    sent = [];
    zooms.length = 0;
    app.replay = { session: "s1", time: 10, duration: 30, ready: 30, playing: false };
    page = new ReplayPage(app as unknown as App, "s1");
    document.body.replaceChildren(page.element);
  });
  afterEach(() => page.dispose());
  const press = (key: string, on: string, more: KeyboardEventInit = {}): boolean => {
    const control = page.element.querySelector(on) as HTMLElement;
    control.focus();
    expect(document.activeElement).toBe(control);
    return page.onkey(new KeyboardEvent("keydown", { key, ...more }));
  };

  it("seek and play from the play button and from the line of time", () => {
    for (const on of [".play", ".scrub"]) {
      app.replay.time = 10;
      sent.length = 0;
      expect(press("ArrowRight", on)).toBe(true);
      expect(press("ArrowLeft", on, { shiftKey: true })).toBe(true);
      expect(press("End", on)).toBe(true);
      expect(sent).toEqual([{ type: "seek", time: 11 }, { type: "seek", time: 6 }, { type: "seek", time: 30 }]);
    }
    expect(press(" ", ".scrub")).toBe(true);
    expect(sent.slice(3)).toEqual([{ type: "seek", time: 0 }, { type: "play" }]); // from the end it plays anew
  });

  it("move a slider of the microscope that is in focus", () => {
    for (const label of ["Magnification", "Focus", "Eye distance"]) {
      for (const key of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp"]) expect(press(key, `[aria-label="${label}"]`), `${key} on ${label}`).toBe(false);
      expect(press("+", `[aria-label="${label}"]`)).toBe(true);
    }
    expect(sent).toEqual([]);
    expect(zooms).toEqual([1, 1, 1]);
  });

  it("go through the list of qualities", () => {
    for (const key of ["ArrowDown", "ArrowUp", " ", "Enter", "Home", "End", "h"]) expect(press(key, "select"), key).toBe(false);
    expect(press("+", "select")).toBe(true);
    expect(sent).toEqual([]);
  });

  it("to a moment that is not computed yet show how far it is, and that it comes by itself", () => {
    app.replay = { session: "s1", time: 10, duration: 30, ready: 12, playing: false };
    const state = (): void => page.onmessage({ type: "replay_state", ...app.replay });
    const note = (): string => page.element.querySelector(".over")!.textContent!;
    state();
    expect(note()).toBe("");
    press("End", ".play");
    expect(note()).toContain("Computing up to 0:30.0");
    expect(note()).toContain("now at 0:12.0");
    expect(page.element.querySelector("progress")!.value).toBeCloseTo(12 / 30);
    app.replay.ready = 20;
    state();
    expect(page.element.querySelector("progress")!.value).toBeCloseTo(20 / 30);
    app.replay.ready = 30;
    state();
    expect(note()).toBe("");
  });

  it("press the button in focus", () => {
    expect(press(" ", ".play")).toBe(false);
    expect(press("Enter", ".segment")).toBe(false);
    expect(sent).toEqual([]);
  });
});

it("a link has Space and Enter, a box to tick Space, a choice its arrows; with Ctrl nothing has any", () => {
  const used = (control: Element, keys: string[], more: KeyboardEventInit = {}) => keys.filter((key) => focusUses(new KeyboardEvent("keydown", { key, ...more }), control));
  const input = (type: string) => Object.assign(document.createElement("input"), { type });
  const keys = [" ", "Enter", "ArrowDown", "Home", "h", "+"];
  expect(used(document.createElement("a"), keys)).toEqual([" ", "Enter"]);
  expect(used(input("checkbox"), keys)).toEqual([" "]);
  expect(used(input("radio"), keys)).toEqual([" ", "ArrowDown"]);
  expect(used(document.createElement("div"), keys)).toEqual([]);
  expect(used(input("range"), keys, { ctrlKey: true })).toEqual([]);
});
