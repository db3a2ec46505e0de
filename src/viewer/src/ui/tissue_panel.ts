// What is shown on the tissue besides itself: strain or pressure with its scale, guides for beginners. Nothing of it in an exam.
import type { Blood, ClientMessage, Frame } from "../messages";
import { cividisRamp } from "../scene/palette";
import { h, setText } from "./dom";

type Kind = "none" | "strain" | "pressure";
const kKinds: [Kind, string][] = [["none", "nothing"], ["strain", "strain of the wall"], ["pressure", "pressure on the surface"]];
const kWords: Record<Exclude<Kind, "none">, string> = { strain: "Largest principal strain since the scene began", pressure: "Force on the surface per area, into the tissue" };

export class TissuePanel {
  readonly element: HTMLElement;
  private readonly legend = h("figure", { class: "overlaylegend", hidden: true });
  private readonly low = h("span", {}, "0");
  private readonly middle = h("span", {}, "");
  private readonly high = h("span", {}, "");
  private readonly most = h("output", { class: "quiet" }, "");
  private readonly caption = h("figcaption", {}, "");
  private readonly blood = h("section", { hidden: true, "aria-label": "Blood" });
  private readonly bloodFacts = h("dl", { class: "facts" });
  private kind: Kind = "none";

  /// `guides`: how many there are; `onguides` shows or hides them.
  constructor(private readonly send: (message: ClientMessage) => boolean, guides: number, guidesOn: boolean, onguides: (on: boolean) => void) {
    const select = h("select", { "aria-label": "Colours on the tissue", onchange: () => this.choose(select.value as Kind) }, ...kKinds.map(([value, text]) => h("option", { value }, text)));
    const box = h("input", { type: "checkbox", checked: guidesOn, onchange: () => onguides(box.checked) });
    this.legend.append(this.caption, h("div", { class: "ramp", style: `background:${cividisRamp()}` }), h("div", { class: "rampticks" }, this.low, this.middle, this.high), this.most);
    this.element = h("section", { class: "panel tissuepanel", "aria-label": "Shown on the tissue" }, h("h3", {}, "Shown on the tissue"),
      h("label", { class: "optic" }, h("span", {}, "Colours"), select), this.legend,
      guides > 0 ? h("label", { class: "optic" }, box, h("span", {}, "Guides: bites and the needle's way")) : null, this.blood);
    this.blood.append(h("h3", {}, "Clamps and blood"), this.bloodFacts);
  }

  private choose(kind: Kind): void {
    this.kind = kind;
    this.send({ type: "overlay", kind });
    this.legend.hidden = kind === "none";
    if (kind !== "none") setText(this.caption, kWords[kind]);
  }

  private showBlood(blood: Blood): void {
    this.blood.hidden = false;
    const leak = blood.leak.reduce((sum, rate) => sum + rate, 0), kMilking = { none: "–", stripping: "held shut by both: strip, then let the first go", filling: "fills", over: "done" };
    const facts: [string, string][] = [["Upstream clamp (U)", blood.clamps[0].off ? `off, ${blood.pressure[0].toFixed(0)} mmHg` : "on"], ["Downstream clamp (Z)", blood.clamps[1].off ? `off, ${blood.pressure[1].toFixed(0)} mmHg` : "on"]];
    if (blood.clamps.some((one) => one.off)) facts.push(["Leak", `${leak.toFixed(1)} ml/min`], ["Flow through", `${blood.through.toFixed(2)} ml/min`], ["Lost", `${blood.lost.toFixed(2)} ml`], ["Milking", kMilking[blood.milking]]);
    this.bloodFacts.replaceChildren(...facts.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
  }

  show(frame: Frame): void {
    if (frame.tissue?.blood) this.showBlood(frame.tissue.blood);
    const { overlay } = frame;
    if (!overlay || overlay.kind !== this.kind) return;
    let most = -Infinity;
    for (const value of overlay.values) most = Math.max(most, value);
    const digits = overlay.full < 10 ? 1 : 0;
    setText(this.middle, (overlay.full / 2).toFixed(digits));
    setText(this.high, `${overlay.full.toFixed(digits)} ${overlay.unit} and more`);
    setText(this.most, `largest now ${most.toFixed(digits)} ${overlay.unit}`);
  }

  /// Leaving the page: nobody looks any more.
  dispose(): void { if (this.kind !== "none") this.send({ type: "overlay", kind: "none" }); }
}
