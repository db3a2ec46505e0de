// Every recorded session, newest first.
import type { App, Page } from "../app";
import type { SessionInfo } from "../messages";
import { sessions } from "../net/api";
import { h } from "./dom";
import { clock, day } from "./format";
import { askBeforeReplays } from "./running_task";

export const kInputNames: Record<string, string> = { pointer: "pointer", demo: "demonstration", device: "attached instruments" };

export class SessionsPage implements Page {
  readonly title = "Sessions";
  readonly element = h("div", { class: "page sessions" });

  constructor(app: App) {
    askBeforeReplays(app, this.element);
    this.element.append(h("h1", {}, "Sessions"), h("p", { role: "status" }, "Loading…"));
    void this.load();
  }

  private async load(): Promise<void> {
    try {
      const { sessions: list } = await sessions();
      this.element.replaceChildren(h("h1", {}, "Sessions"), h("p", { class: "buttons" }, h("a", { class: "button", href: "#/rating" }, "For raters"), h("a", { class: "button", href: "#/agreement" }, "Agreement of raters")), list.length > 0 ? sessionTable(list) : h("p", {}, "Nothing has been recorded yet."));
    } catch (error) {
      this.element.replaceChildren(h("h1", {}, "Sessions"), h("p", { role: "alert" }, `The list cannot be read: ${(error as Error).message}.`),
        h("button", { onclick: () => void this.load() }, "Try again"));
    }
  }
}

export function sessionTable(list: SessionInfo[]): HTMLElement {
  return h("div", { class: "panel" }, h("table", {},
    h("thead", {}, h("tr", {}, ...["Started", "Task", "Input", "Code", "Time", "Points", "Verdict", ""].map((name) => h("th", { scope: "col" }, name)))),
    h("tbody", {}, ...list.map(row))));
}

function verdictOf(one: SessionInfo): string {
  if (one.passed === null) return one.finished ? "not scored" : "cut short";
  if (one.input === "demo") return "demonstration"; // nobody passed
  return one.passed ? "✓ passed" : "✕ not passed";
}

function row(one: SessionInfo): HTMLElement {
  const id = encodeURIComponent(one.id), title = one.title || one.task;
  return h("tr", { "data-session": one.id }, h("td", {}, day(one.started)), h("th", { scope: "row" }, title), h("td", {}, kInputNames[one.input] ?? one.input), h("td", {}, one.code),
    h("td", { class: "number" }, clock(one.seconds)), h("td", { class: "number" }, one.total === null ? "–" : one.total.toFixed(0)), h("td", {}, verdictOf(one)),
    h("td", { class: "links" }, h("a", { class: "button", href: `#/replay/${id}`, "aria-label": `Replay ${title}` }, "Replay"),
      one.total === null ? null : h("a", { class: "button", href: `#/result/${id}`, "aria-label": `Result of ${title}` }, "Result")));
}
