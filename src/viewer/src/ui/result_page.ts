// What the trainer made of a session: score with reasons, knot, curves, paths, events. Nothing is computed here.
import type { App, Page } from "../app";
import type { Result, Scale, Series, ServerMessage } from "../messages";
import { session as fetchSession } from "../net/api";
import { analysisPanel } from "./analysis_panel";
import { h } from "./dom";
import { clock, day, listed, kKnotTitles, kLaboratory, kProposal, measured, milliNewton, quantity, reason, words, eventWords } from "./format";
import { PathPlot } from "./path_plot";
import { pressureMapPanel } from "./pressure_map";
import { icon, knotPicture } from "./pictures";
import { chartsOf, drawChart, type ChartData } from "./plots";
import { better } from "./rating_words";
import { askBeforeReplays, goToReplay } from "./running_task";
import { madeUnder } from "./sessions_page";
import { clampSection, factorSection, handlingSection, joinSection, stitchSection } from "./stitch_panel";

/// Why it is not passed. Results of older sessions may not say.
function reasons(verdict: readonly string[]): HTMLElement {
  return h("ul", { class: "reasons", "aria-label": "Why it is not passed" }, ...verdict.map((why) => h("li", {}, reason(why))));
}

const kAfterEnd = 2; // [s], that a task is still shown after its end: no pause

/// The task's clock stands still while input is silent; events and curves count on, so that theirs is told where it differs.
function timeOf(result: Result): string {
  const scored = clock(result.seconds);
  const end = Math.max(...result.events.map((event) => event.time), ...result.series.map((one) => one.time[one.time.length - 1] ?? 0));
  return end > result.seconds + kAfterEnd ? `${scored} (${clock(end).replace(/\.\d$/, "")} with pauses)` : scored;
}

/// A share that stayed at zero and is not scored: of something that the task does not have.
function isIdle(one: Series, result: Result): boolean {
  return one.unit === "-" && one.value.every((value) => !value) && !result.score.items.some((item) => item.name === one.name);
}

export class ResultPage implements Page {
  readonly title = "Result";
  readonly element = h("div", { class: "page result" });
  private cleanup: (() => void)[] = [];
  private shown: Result | null = null;
  private demonstration = false;
  private made = ""; // when, by whom and under what conditions

  constructor(private readonly app: App, private readonly id: string) {
    askBeforeReplays(app, this.element);
    if (id) void this.load();
    else if (app.result) this.showLast(app.result);
    else this.element.append(h("h1", {}, "Result"), h("p", {}, "There is no result yet."), h("a", { class: "button", href: "#/" }, "Choose a task"));
  }

  onmessage(message: ServerMessage): void {
    if (message.type === "result" && !this.id && message !== this.shown) this.showLast(message);
  }

  /// Of the task that has just ended.
  private showLast(result: Result): void {
    const now = this.app.session;
    this.demonstration = now?.input === "demo";
    this.made = now?.input ? madeUnder({ input: now.input, exam: now.exam }) : "";
    this.show(result);
  }

  dispose(): void { for (const one of this.cleanup) one(); this.cleanup = []; }

  private async load(): Promise<void> {
    this.element.replaceChildren(h("p", { role: "status" }, "Loading…"));
    try {
      const { session, result } = await fetchSession(this.id);
      this.demonstration = session.input === "demo";
      this.made = [day(session.started), session.code, madeUnder(session)].filter((word) => word !== "").join(" · ");
      if (result) this.show(result);
      else this.element.replaceChildren(h("h1", {}, session.title), h("p", {}, "This session was not scored."), this.replayLink(this.id));
    } catch (error) {
      this.element.replaceChildren(h("h1", {}, "Result"), h("p", { role: "alert" }, `The session cannot be shown: ${(error as Error).message}.`), h("a", { class: "button", href: "#/sessions" }, "All sessions"));
    }
  }

  private replayLink(id: string): HTMLElement {
    return h("a", { class: "button", href: `#/replay/${encodeURIComponent(id)}` }, "Replay");
  }

  private show(result: Result): void {
    this.dispose();
    this.shown = result;
    const id = this.id || result.session;
    const share = result.score.max_total > 0 ? result.score.total / result.score.max_total : 0;
    const total = h("div", { class: "total" }, h("span", { class: "points" }, result.score.total.toFixed(0)), h("span", { class: "of" }, `of ${result.score.max_total.toFixed(0)} points`),
      h("div", { class: "track", "aria-hidden": "true" }, h("div", { class: "fill", style: `transform:scaleX(${share.toFixed(3)})` })));
    this.element.replaceChildren(
      h("div", { class: "resulthead" }, h("div", {}, h("h1", {}, result.title), h("p", { class: "quiet" }, `Time ${timeOf(result)}${this.made ? ` · ${this.made}` : ""}`)), this.verdict(result), total,
        h("div", { class: "buttons" }, id ? this.replayLink(id) : h("span", { class: "quiet" }, "not recorded"), h("a", { class: "button primary", href: "#/" }, "Tasks"))),
      ...(result.passed ? [] : [reasons(result.verdict ?? [])]),
      h("div", { class: "resultgrid" }, this.scoreTable(result), this.knotCard(result), this.eventCard(result, id)),
      h("div", { class: "stitchgrid" }, stitchSection(result, id), ...(result.scales ?? []).map((scale, k) => this.scaleCard(scale, k === 0 ? id : null)), joinSection(result.leak, result.stitches, result.lapses), clampSection(result.clamps, result.milking), handlingSection(result.handling), factorSection(result.thrombosis_factors)),
      this.curves(result));
    const map = pressureMapPanel(result.pressure_map), curves = this.element.lastElementChild!;
    if (this.element.textContent!.includes("[P]")) curves.before(h("p", { class: "quiet proposal" }, kProposal));
    if (map) curves.before(map);
    if (!id) return;
    const panel = analysisPanel(id);
    this.element.append(panel.element);
    this.cleanup.push(panel.dispose);
  }

  private verdict(result: Result): HTMLElement {
    if (this.demonstration) return h("div", { class: "verdict shown" }, icon.info(), h("span", {}, "Demonstration"));
    return h("div", { class: `verdict ${result.passed ? "pass" : "fail"}` }, result.passed ? icon.pass() : icon.fail(),
      h("span", {}, result.passed ? "Passed" : result.finished ? "Not passed" : "Not finished"));
  }

  private scoreTable(result: Result): HTMLElement {
    const rows = result.score.items.map((item) => {
      const share = item.max_points > 0 ? Math.max(0, Math.min(1, item.points / item.max_points)) : 0;
      return h("tr", {}, h("th", { scope: "row" }, item.title ?? words(item.name)), h("td", { class: "number" }, measured(item.value, item.unit)),
        h("td", { class: "number" }, h("strong", {}, `${+item.points.toFixed(1)}`), ` / ${+item.max_points.toFixed(1)}`,
          h("div", { class: "track", "aria-hidden": "true" }, h("div", { class: "fill", style: `transform:scaleX(${share.toFixed(3)})` }))),
        h("td", {}, reason(item.why)));
    });
    return h("section", { class: "panel score" }, h("h2", {}, "Score and reasons"),
      h("table", {}, h("thead", {}, h("tr", {}, ...["Measure", "Measured", "Points", "Why"].map((name) => h("th", { scope: "col" }, name)))), h("tbody", {}, ...rows)));
  }

  private knotCard(result: Result): HTMLElement | null {
    const { knot } = result;
    if (!knot) return null;
    const title = kKnotTitles[knot.class] ?? words(knot.class);
    const pull = knot.security_newton === null ? (this.app.session?.knot_test != null && !this.id ? "Being pulled; what it holds follows." : "Not pulled.") : knot.held ? `Held: pulled up to ${milliNewton(knot.security_newton)} without slipping.` : `Slipped at ${milliNewton(knot.security_newton)}.`;
    return h("section", { class: "panel knot" }, h("h2", {}, "Knot"), knotPicture(knot.class, title, false), h("p", { class: "big" }, title),
      h("p", { class: knot.held || knot.security_newton === null ? "" : "alarm" }, knot.held ? icon.pass() : knot.security_newton === null ? icon.info() : icon.warn(), " ", pull));
  }

  /// What the simulator estimates of one of the task's rating scales, and with `id` the way to the raters' forms.
  private scaleCard(scale: Scale, id: string | null): HTMLElement {
    const known = scale.items.filter((item) => item.estimate !== null), sum = known.reduce((total, item) => total + (item.estimate ?? 0), 0);
    const rows = scale.items.map((item) => h("tr", {}, h("th", { scope: "row" }, item.title), h("td", { class: "number" }, item.estimate === null ? "–" : `${item.estimate} / ${scale.most}`), h("td", { class: "quiet" }, reason(item.why))));
    return h("section", { class: "panel scale", "aria-labelledby": `scale-${scale.name}` }, h("h2", { id: `scale-${scale.name}` }, scale.title),
      h("p", { class: "alarm" }, `${scale.label.charAt(0).toUpperCase()}${scale.label.slice(1)}: ${sum} of ${known.length * scale.most} points of the items that can be estimated; ${scale.items.length - known.length} of ${scale.items.length} items are left to a rater. ${better(scale)}`),
      h("table", {}, h("thead", {}, h("tr", {}, ...["Item", "Estimate", "Rests on"].map((name) => h("th", { scope: "col" }, name)))), h("tbody", {}, ...rows)), h("p", { class: "quiet" }, scale.source),
      id ? h("p", { class: "buttons" }, h("a", { class: "button primary", href: `#/rate/${encodeURIComponent(id)}` }, "Rate"), h("a", { class: "button", href: "#/agreement" }, "Agreement")) : null);
  }

  private eventCard(result: Result, id: string | null): HTMLElement {
    const rows = listed(result.events).map((event) => h("li", {},
      id ? h("a", { href: `#/replay/${encodeURIComponent(id)}/${event.time.toFixed(2)}`, title: "Show in the replay" }, `${event.time.toFixed(1)} s`) : h("span", { class: "when" }, `${event.time.toFixed(1)} s`),
      h("span", {}, eventWords(event)), h("span", { class: "quiet" }, event.unit === "-" ? "" : quantity(event.value, event.unit))));
    return h("section", { class: "panel eventlist" }, h("h2", {}, "What happened"), rows.length > 0 ? h("ul", { class: "events" }, ...rows) : h("p", { class: "quiet" }, "Nothing was noted."));
  }

  private curves(result: Result): HTMLElement {
    const section = h("div", { class: "curves" });
    const charts = chartsOf(result.series.filter((one) => one.time.length > 1 && !(kLaboratory.includes(result.task) && /tension|thread/.test(one.name)) &&
      !(result.pressure_map && /tension|thread|grip/.test(one.name)) && !isIdle(one, result))); // blades have neither jaws nor thread
    for (const data of charts) {
      const holder = h("div", { class: "chart" });
      section.append(h("section", { class: "panel" }, h("h2", {}, this.chartTitle(data)), holder));
      requestAnimationFrame(() => {
        if (this.shown !== result || !holder.isConnected) return;
        this.cleanup.push(drawChart(holder, data, result.events, (time) => this.pick(result, time)));
      });
    }
    if (result.paths.length > 0) {
      const plot = new PathPlot(result.paths);
      this.cleanup.push(() => plot.dispose());
      section.append(h("section", { class: "panel" }, h("h2", {}, "Paths of the tips"), plot.element));
    }
    return section;
  }

  private chartTitle({ titles, unit, smaller }: ChartData): string {
    const known: Record<string, string> = { mN: "Forces", "mm/s": "Speed", mm: "Lengths", "°": "Angles" };
    const name = known[unit] && smaller ? `Smaller ${known[unit].toLowerCase()}` : known[unit] ?? (titles.length === 1 ? titles[0] : "Other curves");
    return `${name}${unit ? ` (${unit})` : ""}`;
  }

  private pick(result: Result, time: number): void {
    const id = this.id || result.session;
    if (id) void goToReplay(this.app, this.element, `#/replay/${encodeURIComponent(id)}/${time.toFixed(2)}`);
  }
}
