import { ResultPage } from "@viewer/ui/result_page";
import { madeUnder, SessionsPage, sessionTable } from "@viewer/ui/sessions_page";
import { TasksPage } from "@viewer/ui/tasks_page";
import type { App } from "@viewer/app";
import type { Result, ServerMessage, SessionInfo } from "@viewer/messages";
import { resultOf } from "./sample_frames.mjs";

const info = { id: "s1", task: "knot-square", title: "Square knot", input: "pointer", code: "A17", started: "2026-11-22T01:00:00Z", seconds: 38, finished: true, passed: true, total: 89 } as SessionInfo;
const result = resultOf("s1", 30) as unknown as Result;
const task = { name: "knot-square", title: "Square knot", summary: "Tie it", chapter: "Knots", picture: "knot-square", shown: true, demonstration: false };
let sent: Record<string, unknown>[] = [];
const app = { session: null, result: null, replay: null, hello: { tasks: [task], inputs: ["pointer", "demo"] }, send: (message: Record<string, unknown>) => sent.push(message) > 0, go: () => {} } as unknown as App;
const settled = () => new Promise((done) => setTimeout(done, 20));
const startDialog = () => {
  sent = [];
  const page = new TasksPage(app).element;
  document.body.replaceChildren(page);
  (page.querySelector("button.card") as HTMLElement).click();
  return page.querySelector("dialog.start")!;
};
const submit = async (dialog: Element) => { dialog.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true })); await settled(); };

beforeEach(() => { globalThis.fetch = (async (path: string) => new Response(JSON.stringify(path === "/api/sessions" ? { sessions: [] } : { session: { ...info, input: "demo" }, result }))) as unknown as typeof fetch; });

it("a bad trainee's code is told in our words", async () => {
  const dialog = startDialog(), code = dialog.querySelector("input[type=text]") as HTMLInputElement;
  code.value = "A B";
  await submit(dialog);
  expect(sent).toEqual([]);
  expect(dialog.querySelector("[role=alert]")!.textContent).toContain("letters, digits, - and _ only");
  expect(dialog.querySelector("form")!.noValidate).toBe(true);
});

describe("a demonstration", () => {
  it("is started without a trainee's code, which stays for who moves the instruments", async () => {
    const dialog = startDialog(), code = dialog.querySelector("input[type=text]") as HTMLInputElement;
    code.value = "A17";
    const choose = (input: string) => { const radio = dialog.querySelector(`input[value=${input}]`) as HTMLInputElement; radio.checked = true; radio.dispatchEvent(new Event("change", { bubbles: true })); };
    choose("demo");
    expect(code.disabled).toBe(true);
    await submit(dialog);
    choose("pointer");
    expect(code.disabled).toBe(false);
    await submit(dialog);
    expect(sent).toEqual([{ type: "start", task: "knot-square", input: "demo" }, { type: "start", task: "knot-square", input: "pointer", code: "A17" }]);
  });
  it("is neither passed nor not passed, in the list and on the result", async () => {
    const verdicts = [...sessionTable([info, { ...info, input: "demo" }, { ...info, input: "demo", passed: false }], app).querySelectorAll("tbody tr")].map((row) => row.children[6].textContent);
    expect(verdicts).toEqual(["✓ passed", "demonstration", "demonstration"]);
    const stored = new ResultPage(app, "s1"), live = new ResultPage({ ...app, result, session: { input: "demo" } } as unknown as App, ""), own = new ResultPage({ ...app, result } as unknown as App, "");
    await settled();
    expect([stored, live, own].map((page) => page.element.querySelector(".verdict")!.textContent)).toEqual(["Demonstration", "Demonstration", "Passed"]);
  });
});

it("a curve without a unit that stayed at zero is left out, unless it is scored", () => {
  const shown = (items: object[]) => {
    const series = [{ name: "exposed", title: "Share of the target seen", unit: "-", time: [0, 1], value: [0, 0] }];
    const page = new ResultPage({ ...app, result: { ...result, series, score: { ...result.score, items } } } as unknown as App, "");
    return page.element.querySelector(".curves")!.textContent;
  };
  expect(shown([])).not.toContain("Share of the target seen");
  expect(shown([{ name: "exposed", title: "Target seen", value: 0, unit: "-", points: 0, max_points: 25, why: "" }])).toContain("Share of the target seen");
});

it("a result tells the time with pauses where events or curves go beyond the task's clock", () => {
  const shown = (change: Partial<Result>) => new ResultPage({ ...app, result: { ...result, ...change } } as unknown as App, "").element.querySelector(".resulthead p")!.textContent;
  const event = (time: number) => ({ time, name: "cut", tool: 1, value: 0, unit: "-", text: "" });
  expect(shown({ seconds: 96, series: [], events: [event(20), event(104.1)] })).toBe("Time 1:36.0 (1:44 with pauses)");
  expect(shown({ seconds: 29.5, events: [] })).toBe("Time 0:29.5");
  expect(shown({ seconds: 5, events: [] })).toBe("Time 0:05.0 (0:30 with pauses)");
  expect(shown({ seconds: 5, events: [], series: [] })).toBe("Time 0:05.0");
});

it("a session that is running is listed as that, without a replay", () => {
  const cut = { ...info, finished: false, passed: null, total: null, seconds: 0 } as SessionInfo;
  const cells = (state: string, session: string, knot_test: number | null = null) => [...sessionTable([cut], { session: { state, session, knot_test } } as unknown as App).querySelectorAll("tbody td")].slice(3).map((one) => one.textContent);
  expect(cells("running", "s1")).toEqual(["–", "–", "running", ""]);
  expect(cells("ended", "s1", 0.2)).toEqual(["–", "–", "running", ""]); // its knot is being pulled
  for (const [state, session] of [["running", "s2"], ["ended", "s1"]]) expect(cells(state, session)).toEqual(["0:00.0", "–", "cut short", "Replay"]);
});

it("the lists follow when a session begins or ends", async () => {
  globalThis.fetch = (async () => new Response(JSON.stringify({ sessions: [{ ...info, finished: false, passed: null, total: null }] }))) as unknown as typeof fetch;
  for (const make of [(of: App) => new SessionsPage(of), (of: App) => new TasksPage(of)]) {
    const own = { ...app } as unknown as { session: object | null }, page = make(own as unknown as App);
    const verdict = async () => { await settled(); return page.element.querySelector("tr[data-session]")!.children[6].textContent; };
    expect(await verdict()).toBe("cut short");
    own.session = { state: "running", session: "s1" };
    page.onmessage({ type: "session_state" } as ServerMessage);
    expect(await verdict()).toBe("running");
  }
});

it("says under what conditions a session was made", () => {
  expect(madeUnder({ input: "pointer", exam: false, stiffness: 1 })).toBe("pointer");
  expect(madeUnder({ input: "device", exam: true, stiffness: 2.5 })).toBe("attached instruments, exam, brain 2.5 times as stiff");
});
