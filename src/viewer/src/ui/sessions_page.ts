// Every recorded session, newest first.
import type { App, Page } from "../app";
import type { ServerMessage, SessionInfo } from "../messages";
import { sessions } from "../net/api";
import { h } from "./dom";
import { clock, day } from "./format";
import { askBeforeReplays } from "./running_task";

export const kInputNames: Record<string, string> = { pointer: "pointer", demo: "demonstration", device: "attached instruments" };

/// Who moved the instruments, and what was set: "pointer, exam, brain 2.5 times as stiff".
export function madeUnder(one: { input: string; exam: boolean; stiffness?: number }): string {
  const words = [kInputNames[one.input] ?? one.input, one.exam ? "exam" : "", (one.stiffness ?? 1) === 1 ? "" : `brain ${+one.stiffness!.toFixed(2)} times as stiff`];
  return words.filter((word) => word !== "").join(", ");
}

/// Identifier of the session that is being recorded, or null: its knot may still be pulled after its end.
export function runningNow({ session }: App): string | null {
  return session && (session.state === "running" || (session.state === "ended" && session.knot_test !== null)) ? session.session : null;
}

export class SessionsPage implements Page {
  readonly title = "Sessions";
  readonly element = h("div", { class: "page sessions" });

  private running: string | null = null;

  constructor(private readonly app: App) {
    askBeforeReplays(app, this.element);
    this.element.append(h("h1", {}, "Sessions"), h("p", { role: "status" }, "Loading…"));
    void this.load();
  }

  onmessage(message: ServerMessage): void {
    if (message.type === "session_state" && runningNow(this.app) !== this.running) void this.load();
  }

  private async load(): Promise<void> {
    this.running = runningNow(this.app);
    try {
      const { sessions: list } = await sessions();
      this.element.replaceChildren(h("h1", {}, "Sessions"), h("p", { class: "buttons" }, h("a", { class: "button", href: "#/rating" }, "For raters"), h("a", { class: "button", href: "#/agreement" }, "Agreement of raters")), list.length > 0 ? sessionTable(list, this.app) : h("p", {}, "Nothing has been recorded yet."));
    } catch (error) {
      this.element.replaceChildren(h("h1", {}, "Sessions"), h("p", { role: "alert" }, `The list cannot be read: ${(error as Error).message}.`),
        h("button", { onclick: () => void this.load() }, "Try again"));
    }
  }
}

export function sessionTable(list: SessionInfo[], app: App): HTMLElement {
  const now = runningNow(app);
  return h("div", { class: "panel" }, h("table", {},
    h("thead", {}, h("tr", {}, ...["Started", "Task", "Input", "Code", "Time", "Points", "Verdict", ""].map((name) => h("th", { scope: "col" }, name)))),
    h("tbody", {}, ...list.map((one) => row(one, one.id === now)))));
}

function verdictOf(one: SessionInfo, running: boolean): string {
  if (running) return "running";
  if (one.passed === null) return one.finished ? "not scored" : "cut short";
  if (one.input === "demo") return "demonstration"; // nobody passed
  return one.passed ? "✓ passed" : "✕ not passed";
}

/// `running`: not written to its end yet, so that there is nothing to replay.
function row(one: SessionInfo, running: boolean): HTMLElement {
  const id = encodeURIComponent(one.id), title = one.title || one.task;
  return h("tr", { "data-session": one.id }, h("td", {}, day(one.started)), h("th", { scope: "row" }, title), h("td", {}, madeUnder(one)), h("td", {}, one.code),
    h("td", { class: "number" }, running ? "–" : clock(one.seconds)), h("td", { class: "number" }, one.total === null ? "–" : one.total.toFixed(0)), h("td", {}, verdictOf(one, running)),
    h("td", { class: "links" }, running ? null : h("a", { class: "button", href: `#/replay/${id}`, "aria-label": `Replay ${title}` }, "Replay"),
      one.total === null ? null : h("a", { class: "button", href: `#/result/${id}`, "aria-label": `Result of ${title}` }, "Result")));
}
