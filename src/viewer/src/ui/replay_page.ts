// A recorded session seen again: the same field and bars, with a time line that can be dragged.
import type { App, Page } from "../app";
import type { ReplayState, Result, ServerMessage, TimedEvent } from "../messages";
import type { LineState } from "../net/connection";
import { clear, h, setText } from "./dom";
import { opticsBar } from "./field_view";
import { clock, listed, quantity, eventWords } from "./format";
import { focusUses, microscopeKey, microscopeMouse } from "./microscope_keys";
import { BrainPanel } from "./brain_panel";
import { errorCard, isOf, kClosed, refusalCard, showsRecording } from "./own_recording";
import { ForcePanel, StepPanel, WarningList } from "./panels";
import { TissuePanel } from "./tissue_panel";
import { StitchList } from "./stitch_panel";

const kPanelsEvery = 60; // [ms]
const kSeekEvery = 50; // [ms], while dragging
const kBehind = 0.5; // [s], more than two pictures of a session of twelve minutes

export class ReplayPage implements Page {
  readonly title = "Replay";
  readonly element = h("div", { class: "page live replay foreign" });
  private readonly id: string;
  private readonly view;
  private readonly left = h("aside", { class: "left" });
  private readonly right = h("aside", { class: "right" });
  private readonly warnings = new WarningList();
  private readonly over = h("div", { class: "over" });
  private readonly play = h("button", { class: "primary play", onclick: () => this.toggle() }, "▶ Play");
  private readonly scrub = h("input", { type: "range", min: 0, max: 1, step: 0.01, value: 0, "aria-label": "Time in the recording", class: "scrub" });
  private readonly marks = h("div", { class: "marks", "aria-hidden": "true" });
  private readonly ready = h("div", { class: "ready", "aria-hidden": "true" });
  private readonly computed = h("progress", { max: 1, value: 0, "aria-label": "Share that is computed" });
  private readonly computing = h("p", { class: "loading", role: "status" });
  private readonly computedTo = h("p", { class: "quiet", "aria-hidden": "true" }); // changes ten times a second: not to be read out
  private readonly clock = h("output", { class: "time" }, "");
  private readonly unhook: () => void;
  private steps: StepPanel | null = null;
  private forces: ForcePanel | null = null;
  private brain: BrainPanel | null = null;
  private stitches: StitchList | null = null;
  private tissue: TissuePanel | null = null;
  private wantedStitch: number; // from the address, -1: none
  private result: Result | null = null;
  private events: TimedEvent[] = [];
  private lastPanels = 0;
  private later = 0; // timer of panels that wait
  private lastSeek = 0;
  private dragging = false;
  private wanted: number | null; // [s], where the address of the page asks to go
  private opened = false;
  private refused = false; // its card stays until it is answered

  /// `blind`: what a rater is shown, the field alone without what the simulator found.
  constructor(private readonly app: App, argument: string, private readonly blind = false) {
    const [id, time, stitch] = argument.split("/");
    this.id = id;
    this.wantedStitch = stitch?.startsWith("stitch-") ? Number(stitch.slice(7)) - 1 : -1;
    this.wanted = time !== undefined && Number.isFinite(Number(time)) ? Number(time) : null;
    this.view = app.microscope();
    this.unhook = microscopeMouse(this.view, () => true);
    this.view.onclick = (event) => this.clicked(event);
    this.scrub.addEventListener("input", () => this.dragged());
    this.scrub.addEventListener("change", () => { this.dragging = false; this.seek(Number(this.scrub.value)); });
    const transport = h("div", { class: "transport", role: "group", "aria-label": "Replay" }, this.play, h("div", { class: "timeline" }, this.ready, this.marks, this.scrub), this.clock);
    this.element.append(this.left, h("div", { class: "middle" }, this.view.element, this.warnings.element, this.over), this.right, transport, opticsBar(this.view));
    this.showOpening();
    this.join();
    if (app.online && app.hello) this.open();
    this.view.start();
  }

  focus(): void { this.play.focus({ preventScroll: true }); }

  onmessage(message: ServerMessage): void {
    if (!isOf(this.app, this.id, message)) return;
    switch (message.type) {
      case "hello": this.forget(); this.open(); break;
      case "session_state": this.showWhose(); break;
      case "scene": this.describe(); break;
      case "replay_state": this.showState(); break;
      case "result":
        if (this.blind) break;
        this.keep(message);
        this.describe();
        break;
      case "frame": this.showFrame(); break;
      case "error": if (!this.steps || message.code === "not-in-control") this.showRefusal(message); break;
      default: break;
    }
  }

  online(state: LineState): void { this.element.dataset.line = state; }

  onkey(event: KeyboardEvent): boolean {
    const step = event.shiftKey ? 5 : 1, now = this.replay?.time ?? 0, end = this.replay?.duration ?? 0;
    if (document.activeElement !== this.scrub && focusUses(event)) return false; // the line of time seeks by whole seconds, as the page does
    switch (event.key) {
      case " ": this.toggle(); return true;
      case "ArrowLeft": this.seek(now - step); return true;
      case "ArrowRight": this.seek(now + step); return true;
      case "Home": this.seek(0); return true;
      case "End": this.seek(end); return true;
      case "ArrowDown": return this.jump(this.events.find((one) => one.time > now + 0.02));
      case "ArrowUp": return this.jump([...this.events].reverse().find((one) => one.time < now - 0.02));
      default: return microscopeKey(this.view, event, 0, this.element);
    }
  }

  dispose(): void {
    window.clearTimeout(this.later);
    this.unhook();
    this.tissue?.dispose();
    this.view.onclick = () => {};
    this.view.mark([]);
    this.view.stop();
    if (showsRecording(this.app, this.id) && this.app.session?.in_control) this.app.send({ type: "stop" });
    this.app.replay = null;
  }

  private get replay(): ReplayState | null { return this.app.replay?.session === this.id ? this.app.replay : null; }

  private open(): void {
    if (this.opened) return;
    this.opened = this.app.send({ type: "replay_open", session: this.id });
  }

  private keep(result: Result): void {
    this.events = listed(result.events);
    this.result = result;
  }

  /// Another browser has opened it, and its scene and result have come already: nobody sends them again.
  private join(): void {
    if (this.app.session?.in_control || !showsRecording(this.app, this.id)) return;
    if (this.app.result?.session === this.id && !this.blind) this.keep(this.app.result);
    this.showWhose();
    this.showState();
    this.showFrame();
  }

  private showOpening(): void { this.over.replaceChildren(h("p", { class: "loading", role: "status" }, "Opening the recording…")); }

  /// As before anything of the recording has come.
  private forget(): void {
    this.opened = this.refused = false;
    this.steps = this.forces = this.brain = this.stitches = this.tissue = null;
    this.element.classList.add("foreign");
    clear(this.left);
    clear(this.right);
    this.warnings.show([]);
    this.showOpening();
  }

  /// The trainer does something else, or does again what this page shows.
  private showWhose(): void {
    const mine = showsRecording(this.app, this.id);
    if (mine && !this.steps && this.app.session?.state === "replay") this.describe();
    if (mine || !this.steps) return;
    this.forget();
    this.opened = this.refused = true;
    this.over.replaceChildren(refusalCard(kClosed, "Open it again", () => this.again()));
  }

  private showRefusal(message: { code: string; what: string }): void {
    this.refused = true;
    const watch = h("button", { onclick: () => this.again() }, "Watch");
    this.over.replaceChildren(errorCard(this.app, message, () => this.again(), ...(this.steps ? [watch] : [])));
  }

  /// After a refusal: goes on with what is shown, or asks once more.
  private again(): void {
    this.refused = false;
    if (this.steps) return clear(this.over);
    this.forget();
    this.open();
  }

  private toggle(): void {
    const state = this.replay;
    if (!state) return;
    if (!state.playing && state.time >= state.duration - 0.01) this.seek(0);
    this.app.send({ type: state.playing ? "pause" : "play" });
  }

  private seek(time: number): void {
    const end = this.replay?.duration ?? 0;
    const to = Math.min(end, Math.max(0, time));
    if (this.replay) this.replay.time = to;
    this.app.send({ type: "seek", time: to });
    this.showTime(to, end);
    this.showReady();
  }

  private jump(event: TimedEvent | undefined): boolean {
    if (event) this.seek(event.time);
    return true;
  }

  private dragged(): void {
    this.dragging = true;
    const now = performance.now();
    if (now - this.lastSeek < kSeekEvery) return;
    this.lastSeek = now;
    this.seek(Number(this.scrub.value));
  }

  private describe(): void {
    const { scene } = this.app;
    if (!scene || !showsRecording(this.app, this.id)) return;
    this.element.classList.remove("foreign");
    this.refused = false;
    clear(this.over);
    clear(this.left);
    clear(this.right);
    this.steps = new StepPanel(scene.title);
    if (this.blind) {
      this.left.append(this.steps.element);
      this.right.append(h("p", { class: "quiet" }, "For raters: without what the simulator found."), h("a", { class: "button primary", href: `#/rate/${encodeURIComponent(this.id)}` }, "Rate"), h("a", { class: "button", href: "#/rating" }, "All to rate"));
      return;
    }
    this.forces = new ForcePanel(scene);
    const list = this.events.map((event) => h("li", {}, h("button", { class: "eventbutton", onclick: () => this.seek(event.time) },
      h("span", { class: "when" }, `${event.time.toFixed(1)} s`), h("span", {}, eventWords(event)), h("span", { class: "quiet" }, event.unit === "-" ? "" : quantity(event.value, event.unit)))));
    this.left.append(this.steps.element, h("section", { class: "panel" }, h("h3", {}, "What happened"), h("ul", { class: "events long" }, ...list)));
    this.brain = scene.brain ? new BrainPanel(scene, () => this.view.redraw()) : null;
    this.stitches = this.result?.stitches ? new StitchList(this.result, (stitch, go) => this.showStitch(stitch, go)) : null;
    if (this.stitches) this.right.append(this.stitches.element);
    if (this.stitches && this.wantedStitch >= 0) this.stitches.choose(this.wantedStitch, false);
    this.tissue?.dispose();
    this.tissue = scene.tissue ? new TissuePanel((message) => this.app.send(message), 0, false, () => {}) : null;
    if (this.tissue) this.right.append(this.tissue.element);
    this.right.append(this.brain ? this.brain.element : this.forces.element);
    this.right.append(h("a", { class: "button", href: `#/result/${encodeURIComponent(this.id)}` }, "Score and reasons"));
    this.showMarks();
  }

  /// Marks it in the field; `go` takes the replay to the moment after it was made.
  private showStitch(stitch: number, go: boolean): void {
    this.view.mark(this.stitches?.passesOf(stitch) ?? []);
    const time = this.result?.stitches?.[stitch]?.time;
    if (go && time != null && (this.replay?.time ?? 0) < time) this.seek(time);
  }

  /// A click on a stitch in the field chooses it.
  private clicked(event: MouseEvent): void {
    const stitch = this.stitches?.stitchOf(this.view.passAt(event.clientX, event.clientY)) ?? -1;
    if (stitch >= 0) this.stitches?.choose(stitch, false);
  }

  private showState(): void {
    const state = this.replay;
    if (!state) return;
    this.showReady();
    this.scrub.max = String(state.duration);
    setText(this.play, state.playing ? "❚❚ Pause" : "▶ Play");
    this.showTime(state.time, state.duration);
    if (this.marks.childElementCount === 0) this.showMarks();
    if (this.wanted !== null && state.duration > 0) {
      const to = this.wanted;
      this.wanted = null;
      this.seek(to);
    }
  }

  /// A recording is stepped anew: a moment that the computation has not come to yet is said to come.
  private showReady(): void {
    const state = this.replay;
    if (!state || this.refused) return;
    const share = state.duration > 0 ? Math.min(1, state.ready / state.duration) : 1;
    this.ready.style.width = `calc(${(100 * share).toFixed(1)}% - 16px)`;
    const waits = state.time > state.ready + kBehind;
    if (!waits) return clear(this.over);
    this.computed.value = state.ready / state.time;
    setText(this.computing, `Computing up to ${clock(state.time)}. It is shown when it is there.`);
    setText(this.computedTo, `now at ${clock(state.ready)}`);
    if (!this.computing.isConnected) this.over.replaceChildren(h("div", { class: "card endcard" }, this.computing, this.computed, this.computedTo));
  }

  private showTime(time: number, duration: number): void {
    if (!this.dragging) this.scrub.value = String(time);
    this.scrub.setAttribute("aria-valuetext", `${time.toFixed(1)} of ${duration.toFixed(1)} seconds`);
    setText(this.clock, `${clock(time)} / ${clock(duration)}`);
  }

  private showMarks(): void {
    const duration = this.replay?.duration ?? 0;
    clear(this.marks);
    if (duration <= 0) return;
    for (const event of this.events) this.marks.append(h("span", { style: `left:${((100 * event.time) / duration).toFixed(2)}%`, title: `${event.time.toFixed(1)} s ${eventWords(event)}` }));
  }

  private showFrame(): void {
    const { frame } = this.app;
    const now = performance.now();
    if (!frame || !this.steps) return;
    window.clearTimeout(this.later);
    if (now - this.lastPanels < kPanelsEvery) { // the last frame of a jump is shown, too
      this.later = window.setTimeout(() => this.showFrame(), kPanelsEvery);
      return;
    }
    this.lastPanels = now;
    this.steps.show(frame.task, frame.time);
    if (this.blind) return;
    this.warnings.show(frame.task?.warnings ?? []);
    if (this.app.scene) this.brain?.show(frame, this.app.scene);
    this.tissue?.show(frame);
    this.forces?.show(frame, null);
  }
}
