// Tremor, smoothness and grasp force of a recorded session, as the trainer's analysis gives them: one page with plots, in a frame.
import { analysis, sessions } from "../net/api";
import { h, setText } from "./dom";
import { day, kLaboratory } from "./format";

const kEvery = 500; // [ms]

export function analysisPanel(id: string): { element: HTMLElement; dispose(): void } {
  let timer: number | undefined, gone = false;
  const said = h("p", { role: "status", "aria-live": "polite" }, ""), holder = h("div", { class: "document-holder" });
  const clamped = h("select", { "aria-label": "Recording with the tool clamped" }, h("option", { value: "" }, "none: tremor is not resolved")) as HTMLSelectElement;
  const ask = async (): Promise<void> => {
    window.clearTimeout(timer);
    try {
      const answer = await analysis(id, clamped.value);
      if (gone) return;
      if (answer.state === "working") { setText(said, "Analysing …"); timer = window.setTimeout(() => void ask(), kEvery); return; }
      setText(said, answer.state === "failed" ? `The session cannot be analysed: ${answer.message}` : "");
      if (answer.state === "ready") {
        holder.replaceChildren(h("p", {}, h("a", { href: answer.document, target: "_blank" }, "Open the analysis by itself")),
          h("iframe", { class: "document", src: answer.document, title: "Tremor, smoothness and grasp force of this session" }));
      }
    } catch (error) { setText(said, `The session cannot be analysed: ${(error as Error).message}.`); }
  };
  const button = h("button", { class: "analyse", onclick: () => void ask() }, "Analyse tremor, smoothness and grasp force");
  const across = h("a", { class: "button", href: "#/study" }, "Study across sessions");
  const element = h("section", { class: "panel analysis" }, h("h2", {}, "Laboratory analysis"),
    h("p", {}, h("label", {}, "Noise floor of the device, from a recording with the tool clamped: ", clamped)), h("div", { class: "buttons" }, button, across), said, holder);
  void sessions().then(({ sessions: list }) => {
    const still = list.filter((one) => one.id !== id && one.finished && kLaboratory.includes(one.task)).sort((a, b) => Number(/^clamped/i.test(b.code)) - Number(/^clamped/i.test(a.code)));
    for (const one of still) clamped.append(h("option", { value: one.id }, `${one.code ? `${one.code}: ` : ""}${one.title || one.task}, ${day(one.started)}`));
  }, () => undefined);
  return { element, dispose: () => { gone = true; window.clearTimeout(timer); } };
}
