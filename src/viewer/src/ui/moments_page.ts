// A picture of the moment of every lapse, taken through the microscope while the recording is stepped again. Nothing is stored: the
// pictures are those of this build of the program, and can be taken anew at any time.
import type { App, Page } from "../app";
import type { Lapse, Result, ServerMessage } from "../messages";
import { h, setText } from "./dom";
import { clock, words } from "./format";
import { errorCard, isOf, kClosed, refusalCard, showsRecording } from "./own_recording";
import { lapseValue, replayAt } from "./stitch_panel";

const kOpening = "Opening the recording…";
const kMagnification = 22;
const kClose = 0.06; // [s], a frame this near to the moment is its picture

export class MomentsPage implements Page {
  readonly title = "Moments";
  readonly element = h("div", { class: "page moments foreign" });
  private readonly view;
  private readonly said = h("p", { role: "status", "aria-live": "polite" }, kOpening);
  private readonly computed = h("progress", { max: 1, value: 0, hidden: true, "aria-label": "Share that is computed" });
  private readonly computedTo = h("p", { class: "quiet", "aria-hidden": "true" }); // changes ten times a second: not to be read out
  private readonly refusal = h("div", {});
  private readonly gallery = h("div", { class: "gallery" });
  private result: Result | null = null;
  private at = 0; // lapse whose picture is taken next
  private asked = -1; // lapse whose moment was gone to
  private opened = false;

  constructor(private readonly app: App, private readonly id: string) {
    this.view = app.microscope();
    this.element.append(h("h1", {}, "Moments of the lapses"), this.said, this.computed, this.computedTo, h("div", { class: "buttons" }, h("a", { class: "button", href: `#/result/${encodeURIComponent(id)}` }, "Result")),
      this.refusal, h("div", { class: "momentfield" }, this.view.element), this.gallery);
    this.view.start();
    if (app.online && app.hello) this.open();
  }

  onmessage(message: ServerMessage): void {
    if (!isOf(this.app, this.id, message)) return;
    if (message.type === "hello") this.again();
    if (message.type === "session_state") this.showWhose();
    if (message.type === "result") { this.result = message; this.at = 0; this.asked = -1; this.gallery.replaceChildren(); }
    if (message.type === "replay_state") this.goOn();
    if (message.type === "frame") this.look(message.time);
    if (message.type === "error") this.showRefusal(message);
  }

  dispose(): void {
    this.view.mark([]);
    this.view.stop();
    if (showsRecording(this.app, this.id) && this.app.session?.in_control) this.app.send({ type: "stop" });
    this.app.replay = null;
  }

  private again(): void {
    this.opened = false;
    this.result = null;
    this.refusal.replaceChildren();
    setText(this.said, kOpening);
    this.showReady();
    this.open();
  }

  private showWhose(): void {
    const mine = showsRecording(this.app, this.id);
    this.element.classList.toggle("foreign", !mine || this.app.session?.state !== "replay"); // the scene comes before that state
    if (!mine && this.result) this.stay(refusalCard(kClosed, "Open it again", () => this.again()));
  }

  /// Goes no further, and says why.
  private stay(card: HTMLElement): void {
    this.result = null;
    setText(this.said, "");
    this.showReady();
    this.refusal.replaceChildren(card);
  }

  private showRefusal(message: { code: string; what: string }): void {
    if (this.result && message.code !== "not-in-control") return; // about something else
    this.stay(errorCard(this.app, message, () => this.again()));
  }

  private goOn(): void {
    if (this.refusal.hasChildNodes()) return;
    if (!this.result) setText(this.said, "This session was not scored: no lapses are known of it.");
    else if (this.asked < this.at) this.aim();
    this.showReady();
  }

  /// The recording is stepped anew up to the moment that is waited for.
  private showReady(): void {
    const { lapse } = this, ready = this.app.replay?.ready ?? 0, time = Math.min(lapse?.time ?? 0, this.app.replay?.duration ?? 0);
    this.computed.hidden = !this.result || !lapse || ready >= time;
    if (!this.computed.hidden) this.computed.value = ready / time;
    setText(this.computedTo, this.computed.hidden ? "" : `now at ${clock(ready)} of ${clock(time)}`);
  }

  private open(): void { if (!this.opened) this.opened = this.app.send({ type: "replay_open", session: this.id }); }
  private get lapse(): Lapse | undefined { return this.result?.lapses?.[this.at]; }

  private aim(): void {
    const { lapse } = this, all = this.result?.lapses ?? [];
    if (!lapse) { setText(this.said, all.length > 0 ? `${all.length} ${all.length === 1 ? "lapse" : "lapses"}, each at its moment.` : "No lapse was found: there is nothing to show."); return; }
    setText(this.said, `Stepping the recording to lapse ${this.at + 1} of ${all.length} (${(lapse.time ?? 0).toFixed(1)} s)…`);
    this.asked = this.at;
    this.view.mark(this.passes(lapse));
    this.app.send({ type: "seek", time: lapse.time ?? 0 });
    if (this.app.frame) this.look(this.app.frame.time); // two lapses of one moment: no other frame comes
  }

  private passes(lapse: Lapse): number[] { return (this.result?.stitches?.[lapse.stitch]?.passes ?? []).filter((pass) => pass >= 0); }

  private look(time: number): void {
    const { lapse } = this, end = this.app.replay?.duration ?? 0;
    if (!lapse || this.asked < this.at || Math.abs(time - Math.min(lapse.time ?? 0, end)) > kClose + end / 3600) return;
    this.view.picture(); // the places of the stitches are those of this frame from here on
    this.view.look(this.passes(lapse), kMagnification);
    const picture = this.view.picture();
    const text = `${words(lapse.name)}, ${lapse.stitch < 0 ? "the whole line" : `stitch ${lapse.stitch + 1}`}: ${lapseValue(lapse)}`;
    this.gallery.append(h("figure", { class: "panel" }, h("img", { src: picture, alt: `Field of the microscope at ${time.toFixed(1)} s: ${text}` }),
      h("figcaption", {}, h("strong", {}, text), " ", h("a", { href: replayAt(this.id, lapse.time, lapse.stitch) }, `replay from ${(lapse.time ?? 0).toFixed(1)} s`))));
    this.at += 1;
    this.aim();
    this.showReady();
  }
}
