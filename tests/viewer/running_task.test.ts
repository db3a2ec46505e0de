import { SessionsPage } from "@viewer/ui/sessions_page";
import { TasksPage } from "@viewer/ui/tasks_page";
import type { App } from "@viewer/app";
import type { SessionInfo, SessionState } from "@viewer/messages";

const running = { state: "running", task: "knot-square", in_control: true, controller: 1, session: "s2" } as SessionState;
const info = { id: "s1", task: "knot-square", title: "Square knot", input: "pointer", code: "A17", started: "2026-11-22T01:00:00Z", seconds: 38, finished: true, passed: true, total: 89 } as SessionInfo;
const task = { name: "knot-square", title: "Square knot", summary: "Tie it", chapter: "Knots", picture: "knot-square", shown: true, demonstration: false };
let list: SessionInfo[] = [];
let sent: Record<string, unknown>[] = [], gone: string[] = [];
const appIn = (session: SessionState | null) => ({ session, result: null, replay: null, hello: { tasks: [task], inputs: ["pointer", "demo"] },
  send: (message: Record<string, unknown>) => sent.push(message) > 0, go: (hash: string) => gone.push(hash) }) as unknown as App;
const settled = () => new Promise((done) => setTimeout(done, 20));
const shown = async (page: { element: HTMLElement }) => { document.body.replaceChildren(page.element); await settled(); return page.element; };
const press = async (page: HTMLElement, what: string) => { (page.querySelector(what) as HTMLElement).dispatchEvent(new MouseEvent("click", { bubbles: true, cancelable: true })); await settled(); };
const submit = async (page: HTMLElement) => { page.querySelector("dialog.start form")!.dispatchEvent(new Event("submit", { cancelable: true })); await settled(); };

beforeEach(() => {
  [list, sent, gone] = [[info], [], []];
  globalThis.fetch = (async () => new Response(JSON.stringify({ sessions: list }))) as unknown as typeof fetch;
});

describe("a running task", () => {
  it("is ended by another start only when that is agreed to, and Cancel is what Enter presses", async () => {
    const page = await shown(new TasksPage(appIn(running)));
    await press(page, "button.card");
    await submit(page);
    expect(sent).toEqual([]);
    expect(page.querySelector("dialog.ask")!.textContent).toContain("A task is running: Square knot. It ends now and is scored as far as it went.");
    expect(document.activeElement!.textContent).toBe("Cancel");
    await press(page, "dialog.ask .primary");
    expect([sent, page.querySelector("dialog.ask")]).toEqual([[], null]);
    await submit(page);
    await press(page, ".endtask");
    expect([sent.map((one) => one.task), gone]).toEqual([["knot-square"], ["#/live"]]);
  });
  it("is not asked about where there is none, or where another browser controls it", async () => {
    for (const session of [null, { ...running, state: "ended" }, { ...running, in_control: false }] as (SessionState | null)[]) {
      const page = await shown(new TasksPage(appIn(session)));
      await press(page, "button.card");
      await submit(page);
      expect(page.querySelector("dialog.ask")).toBeNull();
    }
    expect(sent.length).toBe(3);
  });
  it("is asked about where nobody controls it, as after loading the page anew", async () => {
    const page = await shown(new TasksPage(appIn({ ...running, in_control: false, controller: 0 })));
    await press(page, "button.card");
    await submit(page);
    expect([page.querySelectorAll("dialog.ask").length, sent]).toEqual([1, []]);
  });
  it("is ended by a replay only when that is agreed to", async () => {
    const page = await shown(new SessionsPage(appIn(running)));
    await press(page, "a[href='#/replay/s1']");
    expect(gone).toEqual([]);
    await press(page, "dialog.ask .primary");
    expect(gone).toEqual([]);
    await press(page, "a[href='#/replay/s1']");
    await press(page, ".endtask");
    expect(gone).toEqual(["#/replay/s1"]);
    await press(page, "a[href='#/result/s1']");
    expect(page.querySelector("dialog.ask")).toBeNull();
  });
});
