// The task as it runs: field in the middle, what to do on the left, forces on the right.
import type { App, Page } from "../app";
import { PointerInput } from "../input/pointer_input";
import type { Result, Scene, ServerMessage, TimedEvent } from "../messages";
import type { LineState } from "../net/connection";
import { fieldDiameter } from "../scene/optics";
import { BrainPanel } from "./brain_panel";
import { clear, h, setAttribute, setText } from "./dom";
import { opticsBar } from "./field_view";
import { microscopeKey, microscopeMouse } from "./microscope_keys";
import { ForcePanel, HealthPanel, StepPanel, toolTitle, WarningList } from "./panels";
import { quantity, eventWords, kFrequent } from "./format";
import { TissuePanel } from "./tissue_panel";

const kPanelsEvery = 60; // [ms]
const kEventsShown = 5;
const kHelp = /^(pressure-(?!alarm)|dose-|release-|perfusion-)/; // codes of warnings that an exam does without, as blind steps do

export class LivePage implements Page {
  readonly title = "Task";
  readonly element = h("div", { class: "page live" });
  private readonly view;
  private readonly left = h("aside", { class: "left" });
  private readonly right = h("aside", { class: "right" });
  private readonly over = h("div", { class: "over" });
  private readonly hand = h("output", { class: "hand", "aria-live": "polite" }, "");
  private readonly back = h("button", { class: "quietbutton", onclick: () => this.focus() }, "To the field");
  private readonly take = h("button", { class: "take", hidden: true, onclick: () => { this.app.send({ type: "take_control" }); this.focus(); } }, "Take control");
  private readonly events = h("ul", { class: "events", "aria-label": "What happened" });
  private readonly warnings = new WarningList();
  private readonly health = new HealthPanel();
  private readonly pointer: PointerInput;
  private readonly unhook: () => void;
  private steps: StepPanel | null = null;
  private forces: ForcePanel | null = null;
  private brain: BrainPanel | null = null;
  private tissue: TissuePanel | null = null;
  private described: Scene | null = null; // the scene whose panels are shown
  private exam = false;
  private ran: string | null = null; // the session of the task that runs; at rest: of one that had no end
  private ended: Result | null = null; // whose end is shown
  private lastPanels = 0;
  private refused = false; // the last start; its reason stays on the page

  constructor(private readonly app: App) {
    const view = app.microscope();
    this.view = view;
    this.pointer = new PointerInput(view.surface, {
      metresPerPixel: () => view.metresPerPixel,
      fieldMetres: () => fieldDiameter(view.microscope.optics.magnification) / 1000,
      tiltCosine: () => Math.cos(view.microscope.optics.tilt),
    }, (message) => app.send(message));
    this.pointer.onswitch = () => this.showHand();
    this.unhook = microscopeMouse(view, () => !this.pointer.live);
    this.warnings.onnew = (level) => app.sound.play(level);
    this.element.append(this.left, h("div", { class: "middle" }, view.element, h("div", { class: "handbox" }, this.hand, this.take), this.warnings.element, this.over), this.right, opticsBar(view));
    this.showLoading();
    this.showSession();
    view.start();
  }

  focus(): void { this.view.surface.focus({ preventScroll: true }); }

  onmessage(message: ServerMessage): void {
    switch (message.type) {
      case "hello": case "session_state": this.showSession(); break;
      case "scene": if (this.task) this.describe(this.app.scene); break; // without: the state that follows tells whose it is
      case "frame": this.showFrame(); break;
      case "event": this.addEvent(message.event); break;
      case "result": this.showEnd(); break;
      case "replay_state": if (!this.app.session?.in_control) this.toReplay(); break; // opened by another browser; one's own was left for this page
      case "error": this.showRefusal(message.what, message.advice); break;
      default: break;
    }
  }

  online(state: LineState): void {
    this.pointer.enabled = state === "open" && this.steering;
    setAttribute(this.element, "data-line", state);
  }

  onkey(event: KeyboardEvent): boolean {
    if (event.key === "Escape" && document.activeElement === this.view.surface) {
      this.leaveField();
      return true;
    }
    return microscopeKey(this.view, event, this.pointer.hands.active, this.element);
  }

  dispose(): void {
    this.tissue?.dispose();
    this.pointer.dispose();
    this.unhook();
    this.view.stop();
  }

  /// Out of the field by keyboard, to where a Space that was meant for the grip does no harm; with the panels hidden they are shown again.
  private leaveField(): void {
    this.element.classList.remove("bare");
    const to = this.back.isConnected ? this.back : this.element.querySelector<HTMLElement>(".over a, .optics button");
    to?.focus();
  }

  private get steering(): boolean {
    const session = this.app.session;
    return session !== null && session.state === "running" && session.pointer && session.in_control;
  }

  /// A task is what this page shows; scene and result of a replay are none.
  private get task(): boolean { return ["loading", "running", "ended"].includes(this.app.session?.state ?? ""); }

  private describe(scene: Scene | null): void {
    this.described = scene;
    this.exam = this.app.session?.exam === true; // a page loaded again hears of it after the scene
    clear(this.left);
    clear(this.right);
    clear(this.events);
    this.warnings.show([]);
    this.pointer.hands.hands.length = 0;
    this.steps = this.forces = this.brain = this.tissue = null;
    if (!scene) return;
    clear(this.over);
    this.steps = new StepPanel(scene.title);
    this.forces = new ForcePanel(scene);
    const end = h("button", { class: "end", onclick: () => { this.app.send({ type: "stop" }); } }, "End task");
    this.left.append(this.steps.element, h("section", { class: "panel" }, h("h3", {}, "What happened"), this.events), h("div", { class: "buttons" }, this.back, end));
    this.brain = scene.brain ? new BrainPanel(scene, () => this.view.redraw(), this.exam) : null;
    this.tissue = scene.tissue && !this.exam ? new TissuePanel((message) => this.app.send(message), scene.guides?.filter((guide) => guide.in.path.length > 0).length ?? 0, this.view.guidesShown, (on) => this.view.showGuides(on)) : null;
    if (this.tissue) this.right.append(this.tissue.element);
    this.right.append(this.brain ? this.brain.element : this.forces.element);
    this.right.append(this.health.element);
  }

  private showSession(): void {
    const { session } = this.app;
    this.pointer.enabled = this.app.online && this.steering;
    if (!this.steering) this.pointer.hands.hands.length = 0;
    this.element.dataset.state = session?.state ?? "idle";
    if (session?.state === "loading") this.showLoading();
    if (session?.state === "running") this.refused = false;
    if (session && session.state !== "idle") this.ran = session.state === "running" ? session.session : null;
    if (!this.task) this.describe(null);
    else if (session?.state !== "loading" && (this.app.scene !== this.described || (session?.state === "running" && session.exam !== this.exam))) this.describe(this.app.scene);
    if (session?.state === "ended" && this.app.result !== this.ended) this.showEnd();
    if (session?.state === "idle" && !this.refused) this.showNothing();
    this.toReplay();
    const others = session !== null && session.state === "running" && !session.in_control;
    this.take.hidden = !others;
    this.showHand();
  }

  private toReplay(): void {
    if (this.app.session?.state === "replay" && this.app.replay) this.app.go(`#/replay/${encodeURIComponent(this.app.replay.session)}`);
  }

  /// A task always ends before the trainer rests: one that did not was cut short with the program.
  private showNothing(): void {
    const choose = h("a", { class: "button", href: "#/" }, "Choose a task");
    const card = this.ran === null ? [h("p", {}, "No task is running."), choose] : [
      h("p", { class: "big" }, "The task was cut short"), h("p", {}, `The trainer was started anew. Session ${this.ran} is stored up to then, without a score.`),
      h("div", { class: "buttons" }, h("a", { class: "button primary", href: `#/replay/${encodeURIComponent(this.ran)}` }, "Replay"), choose)];
    this.over.replaceChildren(h("div", { class: "card endcard" }, ...card));
  }

  private showLoading(): void {
    this.over.replaceChildren(h("p", { class: "loading", role: "status" }, "Loading the scene…"));
  }

  /// A refused start leaves nothing to wait for.
  private showRefusal(what: string, advice: string): void {
    const state = this.app.session?.state;
    if (state === "running" || state === "replay") return;
    this.refused = true;
    this.over.replaceChildren(h("div", { class: "card endcard" }, h("p", { class: "big" }, "Not started"), h("p", {}, `${what} ${advice}`), h("a", { class: "button", href: "#/" }, "Choose a task")));
  }

  private showFrame(): void {
    const { frame } = this.app;
    if (!frame || !this.steps) return;
    if (this.steering && !this.pointer.hands.ready && this.app.scene) {
      this.pointer.hands.adopt(frame.tools, this.app.scene.tools.map((tool) => tool.max_angle),
        this.app.scene.tools.map((tool) => tool.kind === "scissors"));
      this.showHand();
    }
    const now = performance.now();
    const warnings = frame.task?.warnings ?? [];
    this.warnings.show(this.app.session?.exam ? warnings.filter((one) => !kHelp.test(one.code)) : warnings);
    if (now - this.lastPanels < kPanelsEvery) return;
    this.lastPanels = now;
    if (this.over.querySelector(".loading")) clear(this.over);
    this.element.classList.toggle("exam", this.exam);
    this.steps.show(frame.task, frame.time);
    if (this.app.scene) this.brain?.show(frame, this.app.scene);
    this.forces?.show(frame, this.pointer.live ? this.pointer.hands.active : null);
    this.tissue?.show(frame);
    this.health.show(frame);
  }

  private showHand(): void {
    const { session, scene } = this.app;
    let text = "";
    if (session?.state === "running") {
      if (!session.in_control) text = session.controller > 0 ? "Watching: another browser is in control" : "Watching";
      else if (session.input === "demo") text = "Demonstration";
      else if (session.input === "device" && !session.pointer) text = "Attached instruments";
      else if (scene) text = (session.input === "device" ? "Attached instruments grip, the pointer moves them · " : "") + `Active hand: ${toolTitle(scene.tools[this.pointer.hands.active]?.name ?? "")} (Tab changes${scene.tools.some((tool) => tool.kind === "scissors") ? ", X: scissors" : ""})`;
    }
    setText(this.hand, session?.state === "running" && session.exam ? `Exam · ${text}` : text);
  }

  private addEvent(event: TimedEvent): void {
    if (kFrequent.includes(event.name)) return;
    if (event.name === "blade-change-refused") this.app.sound.play("warn");
    const value = event.unit !== "-" && event.value !== 0 ? ` ${quantity(event.value, event.unit)}` : "";
    this.events.prepend(h("li", {}, h("span", { class: "when" }, `${event.time.toFixed(1)} s`), eventWords(event) + (event.text ? "" : value)));
    while (this.events.children.length > kEventsShown) this.events.lastElementChild!.remove();
  }

  private showEnd(): void {
    const { result, session } = this.app;
    if (!result || !this.task || session?.state === "loading" || result.session !== session?.session) return; // one that comes while loading is of a recording
    this.ended = result;
    this.pointer.enabled = false;
    const link = h("a", { class: "button primary", href: "#/result" }, "Show the result");
    this.over.replaceChildren(h("div", { class: "card endcard" },
      h("p", { class: "big" }, result.finished ? "Task ended" : "Task stopped"), h("p", {}, `${result.score.total.toFixed(0)} of ${result.score.max_total.toFixed(0)} points`), link));
    link.focus();
  }
}
