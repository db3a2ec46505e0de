// How grasp force, accuracy and tremor go together in the recordings of the laboratory's tasks. Chosen here; everything is worked out by the
// trainer, which gives a page with plots and tables, and files for other programs.
import type { App, Page } from "../app";
import type { SessionInfo } from "../messages";
import { sessions, study, type StudyStatus } from "../net/api";
import { h, setText } from "./dom";
import { clock, day, kLaboratory } from "./format";
import { kInputNames } from "./sessions_page";

const kEvery = 300; // [ms]
type Role = "counts" | "clamped" | "out";
const kRoles: Record<Role, string> = { counts: "counts", clamped: "tool clamped: noise floor", out: "left out" };

/// A recording with the code "clamped" is a noise floor; a demonstration is nobody's hand.
export function roleOf(one: SessionInfo): Role {
  return /^clamped/i.test(one.code) ? "clamped" : one.input === "demo" ? "out" : "counts";
}

export class StudyPage implements Page {
  readonly title = "Study";
  readonly element = h("div", { class: "page study" });
  private readonly list = h("div", { class: "studylist" }, h("p", { role: "status" }, "Loading…"));
  private readonly start = h("button", { class: "primary", onclick: () => void this.begin() }, "Work it out") as HTMLButtonElement;
  private readonly stop = h("button", { class: "cancel", hidden: true, onclick: () => void this.ask(() => study.cancel()) }, "Cancel");
  private readonly progress = h("progress", { max: 1, value: 0, hidden: true, "aria-label": "Sessions read" }) as HTMLProgressElement;
  private readonly said = h("p", { role: "status", "aria-live": "polite" }, "");
  private readonly result = h("div", { class: "report" });
  private readonly roles = new Map<string, HTMLSelectElement>();
  private readonly names = new Map<string, string>();
  private timer: number | undefined;
  private gone = false;
  private shown = "";
  private asked = false; // by this page, not an earlier visit

  constructor(_app: App) {
    this.element.append(h("h1", {}, "Study"), h("section", { class: "panel", "aria-labelledby": "study-title" },
      h("h2", { id: "study-title" }, "Grasp force, accuracy and tremor across sessions"),
      h("p", { class: "quiet" }, "Correlations within sessions, across sessions and across people, with effect sizes, intervals and plots, for each of the laboratory's tasks. Tremor counts only where it stands out of the noise floor of its device: record the device once with its tool clamped in a vice (Hold the tip still, code ",
        h("code", {}, "clamped"), ") and mark that recording as noise floor."), this.list,
      h("div", { class: "job" }, this.start, this.progress, this.stop), this.said), this.result);
    void this.load();
  }

  dispose(): void { this.gone = true; window.clearTimeout(this.timer); }

  private async load(): Promise<void> {
    try {
      const all = (await sessions()).sessions.filter((one) => kLaboratory.includes(one.task) && one.finished);
      this.start.disabled = all.length === 0;
      this.list.replaceChildren(...(all.length > 0 ? [this.buttons(all), this.table(all)] : [h("p", {}, "No task of the laboratory has been recorded yet: ", h("a", { href: "#/" }, "choose one"), ".")]));
    } catch (error) { this.list.replaceChildren(h("p", { role: "alert" }, `The recordings cannot be listed: ${(error as Error).message}.`)); }
    await this.ask(() => study.status());
  }

  private buttons(all: SessionInfo[]): HTMLElement {
    const set = (role: (one: SessionInfo) => Role) => (): void => { for (const one of all) this.roles.get(one.id)!.value = role(one); };
    return h("div", { class: "buttons" }, h("button", { onclick: set(roleOf) }, "Hands only"),
      h("button", { onclick: set((one) => (roleOf(one) === "clamped" ? "clamped" : "counts")) }, "All, with demonstrations"), h("button", { onclick: set(() => "out") }, "None"));
  }

  private table(all: SessionInfo[]): HTMLElement {
    const rows = all.map((one) => {
      const title = one.title || one.task, name = `${title}, ${day(one.started)}${one.code ? `, ${one.code}` : ""}`;
      const role = h("select", { "aria-label": name }, ...Object.entries(kRoles).map(([value, text]) => h("option", { value, selected: value === roleOf(one) }, text))) as HTMLSelectElement;
      this.roles.set(one.id, role);
      this.names.set(one.id, name);
      return h("tr", { "data-session": one.id }, h("td", {}, day(one.started)), h("th", { scope: "row" }, title), h("td", {}, one.code || "–"), h("td", {}, kInputNames[one.input] ?? one.input),
        h("td", { class: "number" }, clock(one.seconds)), h("td", {}, role), h("td", { class: "links" }, one.total === null ? null : h("a", { class: "button", href: `#/result/${encodeURIComponent(one.id)}`, "aria-label": `Result of ${name}` }, "Result")));
    });
    return h("div", { class: "long" }, h("table", {}, h("thead", {}, h("tr", {}, ...["Started", "Task", "Code", "Input", "Time", "In the study", ""].map((text) => h("th", { scope: "col" }, text)))), h("tbody", {}, ...rows)));
  }

  private chosen(role: Role): string[] { return [...this.roles].filter(([, select]) => select.value === role).map(([id]) => id); }

  private async begin(): Promise<void> {
    this.shown = "";
    this.asked = true;
    this.result.replaceChildren();
    await this.ask(() => study.start(this.chosen("counts"), this.chosen("clamped")));
  }

  private async ask(what: () => Promise<StudyStatus>): Promise<void> {
    window.clearTimeout(this.timer);
    try { this.show(await what()); } catch (error) { setText(this.said, (error as Error).message.replace("sessions: found 0, expected 1 to 1000 recordings", "Choose at least one session.")); }
  }

  private show(status: StudyStatus): void {
    const running = status.state === "running";
    this.progress.hidden = this.stop.hidden = !running;
    this.progress.value = status.of > 0 ? status.at / status.of : 0;
    const words: Record<StudyStatus["state"], string> = { idle: "", running: `Reading session ${Math.min(status.at + 1, status.of)} of ${status.of} …`, done: "", cancelled: "Cancelled.", failed: status.message };
    const left = status.left_out.map(({ id, why }) => `${this.names.get(id) ?? id} is left out: ${why}`);
    setText(this.said, [words[status.state], ...left].filter((text) => text !== "").join(" "));
    if (running && !this.gone) this.timer = window.setTimeout(() => void this.ask(() => study.status()), kEvery);
    const key = JSON.stringify([status.state, status.tasks, status.at]);
    if (status.state !== "done" || key === this.shown) return;
    this.shown = key;
    this.showResult(status.tasks);
  }

  private showResult(tasks: string[]): void {
    const file = (name: string, text: string) => h("a", { class: "button", href: `/documents/study/${name}`, download: name }, text);
    this.result.replaceChildren(h("section", { class: "panel", "aria-labelledby": "study-result" }, h("h2", { id: "study-result" }, "Result"),
      h("p", { class: "buttons" }, h("a", { class: "button", href: "/documents/study/study.html", target: "_blank" }, "Open by itself"), ...tasks.map((task) => file(`plot-${task}.svg`, `Plot ${task} (SVG)`)),
        file("sessions.csv", "Sessions (CSV)"), file("parts.csv", "Parts (CSV)"), file("study.json", "All (JSON)")),
      h("iframe", { class: "document", src: "/documents/study/study.html", title: "Study: plots, effect sizes, sessions" })));
    if (this.asked) this.result.scrollIntoView({ block: "start" });
  }
}
