// A rater's form for one stored session. The simulator's estimates are shown only after the rater has given marks of their own, so that
// they do not lead the rater. Raters are codes.
import type { App, Page } from "../app";
import type { Scale, ScaleItem } from "../messages";
import { ratings, type Rated, type RatingStatus } from "../net/api";
import { h, setText } from "./dom";
import { day } from "./format";
import { stitchHint } from "./rating_words";

const kSimulator = "simulator";

export class RatePage implements Page {
  readonly title = "Rate";
  readonly element = h("div", { class: "page rate" });
  private readonly trouble = h("p", { class: "trouble", role: "alert" }, "");
  private readonly code = h("input", { type: "text", maxlength: 32, pattern: "[A-Za-z0-9_\\-]+", autocomplete: "off", required: true, placeholder: "e.g. R3", name: "rater" });
  private readonly given = h("div", {});

  constructor(_app: App, private readonly id: string) {
    this.element.append(h("h1", {}, "Rate"), h("p", { role: "status" }, "Loading…"));
    void this.load();
  }

  private async load(): Promise<void> {
    try { this.show(await ratings.of(this.id)); } catch (error) {
      this.element.replaceChildren(h("h1", {}, "Rate"), h("p", { role: "alert" }, `The session cannot be rated: ${(error as Error).message}.`), h("a", { class: "button", href: "#/sessions" }, "All sessions"));
    }
  }

  private show(status: RatingStatus): void {
    const { scale } = status, session = encodeURIComponent(this.id);
    const links = h("div", { class: "buttons" }, h("a", { class: "button", href: `#/replay/${session}` }, "Replay"), h("a", { class: "button", href: `#/result/${session}` }, "Result"), h("a", { class: "button", href: "#/agreement" }, "Agreement"));
    if (!scale) {
      this.element.replaceChildren(h("h1", {}, `Rate: ${status.title}`), h("p", {}, "This task has no rating scale."), links);
      return;
    }
    this.element.replaceChildren(h("h1", {}, `Rate: ${status.title}`), links,
      ...(status.trouble ? [h("p", { class: "alarm", role: "alert" }, `Marks cannot be stored: ${status.trouble}`)] : []),
      h("section", { class: "panel", "aria-labelledby": "scale-title" }, h("h2", { id: "scale-title" }, scale.title), h("p", { class: "quiet" }, scale.source), h("p", { class: "quiet" }, stitchHint), this.form(scale)), this.given);
    this.showGiven(scale, status.ratings);
  }

  private form(scale: Scale): HTMLElement {
    const form = h("form", { onsubmit: (event: Event) => { event.preventDefault(); void this.send(scale, form); } },
      h("label", { class: "line-input" }, "Your code (no name)", this.code),
      ...scale.items.map((item) => this.question(item)), this.trouble,
      h("div", { class: "buttons" }, h("button", { type: "submit", class: "primary" }, "Store my marks"))) as HTMLFormElement;
    return form;
  }

  private question(item: ScaleItem): HTMLElement {
    return h("fieldset", { class: "item", "data-item": item.name }, h("legend", {}, item.title), ...item.points.map((text, points) =>
      h("label", { class: "choice" }, h("input", { type: "radio", name: `item-${item.name}`, value: points, required: true }), h("span", {}, h("strong", {}, String(points)), ` ${text}`))));
  }

  private async send(scale: Scale, form: HTMLFormElement): Promise<void> {
    const marks: Record<string, number> = {};
    for (const item of scale.items) {
      const chosen = form.querySelector<HTMLInputElement>(`input[name="item-${CSS.escape(item.name)}"]:checked`);
      if (chosen) marks[item.name] = Number(chosen.value);
    }
    try {
      const status = await ratings.put(this.id, this.code.value, marks);
      setText(this.trouble, "");
      this.showGiven(scale, status.ratings);
      this.given.scrollIntoView({ block: "nearest" });
    } catch (error) { setText(this.trouble, (error as Error).message); }
  }

  /// Every rater's marks side by side, the simulator's last.
  private showGiven(scale: Scale, given: Rated[]): void {
    if (given.length === 0) { this.given.replaceChildren(h("p", { class: "quiet" }, "The simulator's estimates are shown once marks are stored.")); return; }
    const raters = [...given].sort((a, b) => Number(a.rater === kSimulator) - Number(b.rater === kSimulator));
    const rows = scale.items.map((item) => h("tr", {}, h("th", { scope: "row" }, item.title), ...raters.map((one) => h("td", { class: "number" }, one.marks[item.name] === undefined ? "–" : String(one.marks[item.name]))), h("td", { class: "quiet" }, item.why)));
    const total = h("tr", { class: "sum" }, h("th", { scope: "row" }, "Sum"), ...raters.map((one) => h("td", { class: "number" }, scale.items.every((item) => one.marks[item.name] !== undefined) ? String(scale.items.reduce((sum, item) => sum + one.marks[item.name], 0)) : "–")), h("td", {}, ""));
    this.given.replaceChildren(h("section", { class: "panel given", "aria-labelledby": "given-title" }, h("h2", { id: "given-title" }, "Marks given"),
      h("div", { class: "long" }, h("table", {}, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Item"), ...raters.map((one) => h("th", { scope: "col" }, one.rater === kSimulator ? "simulator (estimate)" : one.rater, h("span", { class: "unit" }, day(one.stored)))), h("th", { scope: "col" }, "What the estimate rests on"))), h("tbody", {}, ...rows, total)))));
  }
}
