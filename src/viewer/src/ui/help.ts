// The list of keys, as a window over the page.
import { kShortcuts } from "../input/shortcuts";
import { h } from "./dom";

export class Help {
  readonly element: HTMLDialogElement;

  constructor() {
    this.element = h("dialog", { class: "help", "aria-labelledby": "help-title" },
      h("header", {}, h("h1", { id: "help-title" }, "Keys"), h("button", { class: "quietbutton", onclick: () => this.element.close() }, "Close (Esc)")),
      h("div", { class: "columns" }, ...kShortcuts.map((group) => h("section", {}, h("h2", {}, group.title),
        h("dl", {}, ...group.shortcuts.flatMap(({ keys, does }) => [h("dt", {}, h("kbd", {}, keys)), h("dd", {}, does)]))))));
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}
