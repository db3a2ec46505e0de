// How far raters, and the simulator's estimates, agree: worked out by the trainer, shown and given as files here.
import type { App, Page } from "../app";
import { ratings, type AgreementRow, type AgreementStatus } from "../net/api";
import { h } from "./dom";
import { words } from "./format";

const number = (value: number | null, digits = 2): string => (value === null ? "–" : value.toFixed(digits));
const share = (value: number | null): string => (value === null ? "–" : `${(100 * value).toFixed(0)} %`);

export class AgreementPage implements Page {
  readonly title = "Agreement";
  readonly element = h("div", { class: "page agreement" });

  constructor(_app: App) {
    this.element.append(h("h1", {}, "Agreement of raters"), h("p", { role: "status" }, "Loading…"));
    void this.load();
  }

  private async load(): Promise<void> {
    try { this.show(await ratings.agreement()); } catch (error) {
      this.element.replaceChildren(h("h1", {}, "Agreement of raters"), h("p", { role: "alert" }, `It cannot be worked out: ${(error as Error).message}.`));
    }
  }

  private show(status: AgreementStatus): void {
    const raters = new Set(status.ratings.map((one) => one.rater).filter((code) => code !== "simulator")), sessions = new Set(status.ratings.map((one) => one.session));
    const file = (name: string, text: string) => h("a", { class: "button", href: `/documents/agreement/${name}`, download: name }, text);
    this.element.replaceChildren(h("h1", {}, "Agreement of raters"),
      ...(status.trouble ? [h("p", { class: "alarm", role: "alert" }, status.trouble)] : []),
      h("section", { class: "panel" }, h("p", {}, `${raters.size} ${raters.size === 1 ? "rater has" : "raters have"} marked ${sessions.size} ${sessions.size === 1 ? "session" : "sessions"}. The simulator's marks are estimates, not validated.`),
        h("p", { class: "quiet" }, "Kappa: Cohen's, quadratic weights (for items of 0 and 1 the plain one); 1 is full agreement, 0 that of chance; interval (95 %) by resampling sessions, from five sessions on. ICC(2,1): absolute agreement of single ratings. Difference: mean of the first rater's points less the second's."),
        status.agreement.length > 0 ? h("div", { class: "long" }, this.table(status.agreement)) : h("p", {}, "Two marks of one session are needed: open a result and choose Rate."),
        h("p", { class: "buttons" }, file("agreement.csv", "Agreement (CSV)"), file("ratings.csv", "All marks (CSV)"), file("agreement.json", "All (JSON)"))));
  }

  private table(rows: AgreementRow[]): HTMLElement {
    const names = ["Scale", "Item", "Raters", "Sessions", "Same points", "Difference", "Kappa", "95 %", "ICC(2,1)"];
    return h("table", {}, h("thead", {}, h("tr", {}, ...names.map((name) => h("th", { scope: "col" }, name)))), h("tbody", {}, ...rows.map((row) =>
      h("tr", { class: row.item === "total" ? "sum" : null }, h("td", {}, row.scale.toUpperCase()), h("th", { scope: "row" }, words(row.item)), h("td", {}, row.b ? `${row.a} and ${row.b}` : `all ${row.raters}`), h("td", { class: "number" }, String(row.sessions)),
        h("td", { class: "number" }, share(row.same)), h("td", { class: "number" }, number(row.bias)), h("td", { class: "number" }, number(row.kappa)), h("td", { class: "number" }, row.kappa_low === null ? "–" : `${number(row.kappa_low)} to ${number(row.kappa_high)}`), h("td", { class: "number" }, number(row.icc))))));
  }
}
