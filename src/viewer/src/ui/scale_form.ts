// A rater's form of one rating scale, and under it the marks given by it: of others only after this rater's own, so that they do not lead.
import type { Scale, ScaleItem } from "../messages";
import type { Rated } from "../net/api";
import { h, setText } from "./dom";
import { day, reason } from "./format";
import { better } from "./rating_words";

const kSimulator = "simulator";

export class ScaleForm {
  readonly element: HTMLElement;
  private readonly trouble = h("p", { class: "trouble", role: "alert" }, "");
  private readonly given = h("div", { "aria-live": "polite" });
  private readonly form: HTMLFormElement;

  /// `unready`: what must be mended above the form first, or nothing. `send` stores marks and answers with a refusal's text, or with nothing.
  constructor(private readonly scale: Scale, private readonly unready: () => string, private readonly send: (marks: Record<string, number>) => Promise<string>) {
    const title = `scale-${scale.name}`;
    this.form = h("form", { novalidate: true, onsubmit: (event: Event) => { event.preventDefault(); void this.submit(); }, "aria-labelledby": title },
      ...scale.items.map((item) => this.question(item)), this.trouble,
      h("div", { class: "buttons" }, h("button", { type: "submit", class: "primary" }, "Store my marks")));
    this.element = h("section", { class: "panel", "data-scale": scale.name, "aria-labelledby": title }, h("h2", { id: title }, scale.title),
      h("p", {}, better(scale)), h("p", { class: "quiet" }, scale.source), this.form, this.given);
  }

  /// Radio buttons as browsers have them (Tab to the item, arrows choose); the key of a number chooses as well.
  private question(item: ScaleItem): HTMLElement {
    const choices = item.points.map((_, points) => h("input", { type: "radio", name: `item-${item.name}`, value: points, required: true }));
    const choose = (event: KeyboardEvent) => {
      const choice = event.ctrlKey || event.altKey || event.metaKey ? undefined : choices[Number.parseInt(event.key, 10)];
      if (!choice) return;
      choice.checked = true;
      choice.focus();
    };
    return h("fieldset", { class: this.scale.most === 1 ? "item two" : "item", "data-item": item.name, onkeydown: choose }, h("legend", {}, item.title),
      ...item.points.map((text, points) => h("label", { class: "choice" }, choices[points], h("span", {}, h("strong", {}, String(points)), ` ${text}`))));
  }

  private async submit(): Promise<void> {
    const marks: Record<string, number> = {};
    for (const item of this.scale.items) {
      const chosen = this.form.querySelector<HTMLInputElement>(`input[name="item-${CSS.escape(item.name)}"]:checked`);
      if (chosen) marks[item.name] = Number(chosen.value);
    }
    const refusal = this.unready() || this.unmarked(marks) || (await this.send(marks));
    setText(this.trouble, refusal);
    if (!refusal) this.given.scrollIntoView({ block: "nearest" });
  }

  /// The trainer takes whole forms only.
  private unmarked(marks: Record<string, number>): string {
    const missing = this.scale.items.filter((item) => marks[item.name] === undefined);
    if (missing.length === 0) return "";
    this.form.querySelector<HTMLInputElement>(`input[name="item-${CSS.escape(missing[0].name)}"]`)?.focus();
    return `Every item needs a mark. Still without one: ${missing.map((item) => item.title).join(", ")}.`;
  }

  /// Every rater's marks by this scale side by side, the simulator's last, if `rater` is among them.
  show(ratings: readonly Rated[], rater: string): void {
    const given = ratings.filter((one) => one.scale === this.scale.name);
    if (!given.some((one) => one.rater === rater)) {
      const people = given.filter((one) => one.rater !== kSimulator).length;
      this.given.replaceChildren(h("p", { class: "quiet" }, people === 0 ? "Nobody has marked this yet." : `${people} ${people === 1 ? "rater has" : "raters have"} marked this; the marks are shown once yours are stored.`));
      return;
    }
    const raters = [...given].sort((a, b) => Number(a.rater === kSimulator) - Number(b.rater === kSimulator));
    this.given.replaceChildren(h("section", { class: "given", "aria-labelledby": `given-${this.scale.name}` }, h("h3", { id: `given-${this.scale.name}` }, "Marks given"), h("div", { class: "long" }, this.table(raters))));
  }

  private table(raters: readonly Rated[]): HTMLElement {
    const { items } = this.scale;
    const mark = (one: Rated, item: ScaleItem): string => one.marks[item.name] === undefined ? "–" : String(one.marks[item.name]);
    const sum = (one: Rated): string => items.every((item) => one.marks[item.name] !== undefined) ? String(items.reduce((total, item) => total + one.marks[item.name], 0)) : "–";
    const name = (one: Rated): string => one.rater === kSimulator ? "simulator (estimate)" : one.rater;
    return h("table", {}, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Item"), ...raters.map((one) => h("th", { scope: "col" }, name(one), h("span", { class: "unit" }, day(one.stored)))), h("th", { scope: "col" }, "What the estimate rests on"))),
      h("tbody", {}, ...items.map((item) => h("tr", {}, h("th", { scope: "row" }, item.title), ...raters.map((one) => h("td", { class: "number" }, mark(one, item))), h("td", { class: "quiet" }, reason(item.why)))),
        h("tr", { class: "sum" }, h("th", { scope: "row" }, "Sum"), ...raters.map((one) => h("td", { class: "number" }, sum(one))), h("td", {}, ""))));
  }
}
