// Sessions that raters have a form for, without points, verdict or code, so that nothing leads a rater.
import type { App, Page } from "../app";
import type { SessionInfo } from "../messages";
import { sessions, tasks } from "../net/api";
import { h } from "./dom";
import { clock, day } from "./format";
import { askBeforeReplays } from "./running_task";

export class RatingPage implements Page {
  readonly title = "For raters";
  readonly element = h("div", { class: "page sessions" });

  constructor(app: App) {
    askBeforeReplays(app, this.element);
    this.element.append(h("h1", {}, "For raters"), h("p", { role: "status" }, "Loading…"));
    void this.load();
  }

  private async load(): Promise<void> {
    try {
      const [{ sessions: all }, { tasks: known }] = await Promise.all([sessions(), tasks()]);
      const rated = new Set(known.filter((task) => task.rated).map((task) => task.name));
      this.show(all.filter((one) => one.total !== null && rated.has(one.task)));
    } catch (error) {
      this.element.replaceChildren(h("h1", {}, "For raters"), h("p", { role: "alert" }, `The list cannot be read: ${(error as Error).message}.`),
        h("button", { onclick: () => void this.load() }, "Try again"));
    }
  }

  private show(list: SessionInfo[]): void {
    this.element.replaceChildren(h("h1", {}, "For raters"),
      h("p", { class: "quiet" }, "Watch a session, then rate it. Nothing here shows who did it or what the simulator found; its estimates appear once your marks are stored."),
      list.length > 0 ? h("div", { class: "panel" }, h("table", {},
        h("thead", {}, h("tr", {}, ...["Started", "Task", "Time", ""].map((name) => h("th", { scope: "col" }, name)))), h("tbody", {}, ...list.map(row)))) : h("p", {}, "Nothing has been recorded yet that raters have a form for."),
      h("p", { class: "buttons" }, h("a", { class: "button", href: "#/agreement" }, "Agreement of raters")));
  }
}

function row(one: SessionInfo): HTMLElement {
  const id = encodeURIComponent(one.id), title = one.title || one.task;
  return h("tr", { "data-session": one.id }, h("td", {}, day(one.started)), h("th", { scope: "row" }, title), h("td", { class: "number" }, clock(one.seconds)),
    h("td", { class: "links" }, h("a", { class: "button", href: `#/watch/${id}`, "aria-label": `Watch ${title}` }, "Watch"), h("a", { class: "button", href: `#/rate/${id}`, "aria-label": `Rate ${title}` }, "Rate")));
}
