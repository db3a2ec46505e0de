// Raters' forms for one stored session, one for each scale of its task; each is stored by itself. Raters are codes.
import type { App, Page } from "../app";
import type { Scale } from "../messages";
import { ratings, type RatingStatus } from "../net/api";
import { h } from "./dom";
import { kProposal } from "./format";
import { formsHint, stitchHint } from "./rating_words";
import { askBeforeReplays } from "./running_task";
import { ScaleForm } from "./scale_form";

export class RatePage implements Page {
  readonly title = "Rate";
  readonly element = h("div", { class: "page rate" });
  private readonly code = h("input", { type: "text", maxlength: 32, pattern: "[A-Za-z0-9_\\-]+", autocomplete: "off", required: true, placeholder: "e.g. R3", name: "rater", onchange: () => this.showGiven() });
  private readonly proposal = h("p", { class: "quiet", hidden: true }, kProposal);
  private forms: ScaleForm[] = [];
  private status: RatingStatus | null = null;

  constructor(app: App, private readonly id: string) {
    askBeforeReplays(app, this.element);
    this.element.append(h("h1", {}, "Rate"), h("p", { role: "status" }, "Loading…"));
    void this.load();
  }

  private async load(): Promise<void> {
    try { this.show(await ratings.of(this.id)); } catch (error) {
      this.element.replaceChildren(h("h1", {}, "Rate"), h("p", { role: "alert" }, `The session cannot be rated: ${(error as Error).message}.`), h("a", { class: "button", href: "#/sessions" }, "All sessions"));
    }
  }

  private show(status: RatingStatus): void {
    const { scales } = status, session = encodeURIComponent(this.id);
    const links = h("div", { class: "buttons" }, h("a", { class: "button", href: `#/watch/${session}` }, "Watch"), h("a", { class: "button", href: "#/rating" }, "All to rate"), h("a", { class: "button", href: "#/agreement" }, "Agreement"));
    if (scales.length === 0) {
      this.element.replaceChildren(h("h1", {}, `Rate: ${status.title}`), h("p", {}, "This task has no rating scale."), links);
      return;
    }
    this.forms = scales.map((scale) => new ScaleForm(scale, () => this.codeTrouble(), (marks) => this.send(scale, marks)));
    this.element.replaceChildren(h("h1", {}, `Rate: ${status.title}`), links,
      ...(status.trouble ? [h("p", { class: "alarm", role: "alert" }, `Marks cannot be stored: ${status.trouble}`)] : []),
      h("p", { class: "quiet" }, stitchHint, scales.length > 1 ? ` ${formsHint}` : "", " By keyboard: Tab goes from item to item, the number of points or the arrows choose, Enter stores the form."),
      h("label", { class: "line-input" }, "Your code (no name)", this.code), ...this.forms.map((form) => form.element), this.proposal);
    this.status = status;
    this.showGiven();
  }

  private codeTrouble(): string {
    if (this.code.checkValidity()) return "";
    this.code.focus();
    return this.code.value === "" ? "Your code is missing: it stands above the forms." : "Your code, above the forms, may hold letters, digits, - and _ only.";
  }

  /// A refusal's text, or nothing: they are stored.
  private async send(scale: Scale, marks: Record<string, number>): Promise<string> {
    try {
      this.status = await ratings.put(this.id, scale.name, this.code.value, marks);
    } catch (error) {
      return (error as Error).message;
    }
    this.showGiven();
    return "";
  }

  private showGiven(): void {
    for (const form of this.forms) form.show(this.status?.ratings ?? [], this.code.value);
    this.proposal.hidden = !this.forms.some((form) => form.element.textContent!.includes("[P]"));
  }
}
