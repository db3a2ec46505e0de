// What is shown on the tissue besides itself: strain or pressure with its scale, guides for beginners. Nothing of it in an exam.
import type { ClientMessage, Frame } from "../messages";
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
  private kind: Kind = "none";

  /// `guides`: how many there are; `onguides` shows or hides them.
  constructor(private readonly send: (message: ClientMessage) => boolean, guides: number, guidesOn: boolean, onguides: (on: boolean) => void) {
    const select = h("select", { "aria-label": "Colours on the tissue", onchange: () => this.choose(select.value as Kind) }, ...kKinds.map(([value, text]) => h("option", { value }, text)));
    const box = h("input", { type: "checkbox", checked: guidesOn, onchange: () => onguides(box.checked) });
    this.legend.append(this.caption, h("div", { class: "ramp", style: `background:${cividisRamp()}` }), h("div", { class: "rampticks" }, this.low, this.middle, this.high), this.most);
    this.element = h("section", { class: "panel tissuepanel", "aria-label": "Shown on the tissue" }, h("h3", {}, "Shown on the tissue"),
      h("label", { class: "optic" }, h("span", {}, "Colours"), select), this.legend,
      guides > 0 ? h("label", { class: "optic" }, box, h("span", {}, "Guides: bites and the needle's way")) : null);
  }

  private choose(kind: Kind): void {
    this.kind = kind;
    this.send({ type: "overlay", kind });
    this.legend.hidden = kind === "none";
    if (kind !== "none") setText(this.caption, kWords[kind]);
  }

  show(frame: Frame): void {
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
