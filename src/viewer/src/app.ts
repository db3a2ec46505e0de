// What the viewer knows and which page is shown. Pages get messages from here and send through here.
import { Connection, type LineState } from "./net/connection";
import type { ClientMessage, Frame, Hello, Result, Scene, ServerMessage, SessionState, ReplayState } from "./messages";
import { FieldView } from "./ui/field_view";
import { h, setText } from "./ui/dom";
import { Help } from "./ui/help";
import { focusUses } from "./ui/microscope_keys";
import { icon } from "./ui/pictures";
import { Sound } from "./ui/sound";

export interface Page {
  readonly element: HTMLElement;
  readonly title: string;
  onmessage?(message: ServerMessage): void;
  onkey?(event: KeyboardEvent): boolean; // true: used
  online?(state: LineState): void;
  focus?(): void;
  dispose?(): void;
}

export type PageMaker = (app: App, argument: string) => Page;

const kLines: Record<LineState, string> = { connecting: "Connecting…", open: "Connected", lost: "Connection lost: trying again" };

export class App {
  hello: Hello | null = null;
  session: SessionState | null = null;
  scene: Scene | null = null;
  frame: Frame | null = null;
  result: Result | null = null;
  replay: ReplayState | null = null;
  readonly sound = new Sound();
  readonly help = new Help();
  private pulling = false;
  private hadControl = false;
  private view: FieldView | null = null;
  private page: Page | null = null;
  private readonly main = h("main", { id: "main", tabindex: -1 });
  private readonly line = h("output", { class: "line", "data-state": "connecting" }, kLines.connecting);
  private readonly notice = h("div", { class: "notices", role: "status", "aria-live": "polite" });
  private readonly recording = h("span", { class: "recording", hidden: true }, "● recording");
  private readonly soundButton = h("button", { class: "quietbutton", title: "Warning sounds (M)", onclick: () => this.toggleSound() }, "");
  private readonly connection: Connection;

  constructor(root: HTMLElement, private readonly routes: Record<string, PageMaker>) {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.connection = new Connection(`${scheme}://${location.host}/ws`);
    root.append(
      h("a", { class: "skip", href: "#main", onclick: (event: Event) => { event.preventDefault(); this.main.focus(); } }, "To the content"),
      h("header", { class: "top" },
        h("a", { class: "brand", href: "#/" }, "Filum"),
        h("nav", { "aria-label": "Pages" }, h("a", { href: "#/" }, "Tasks"), h("a", { href: "#/sessions" }, "Sessions"), h("a", { href: "#/laboratory" }, "Laboratory"), h("a", { href: "#/study" }, "Study")),
        h("span", { class: "spacer" }), this.recording, this.line,
        this.soundButton, h("button", { class: "quietbutton", title: "Keys (?)", onclick: () => this.help.toggle() }, "Keys (?)")),
      this.notice, this.main, this.help.element);
    this.showSound();
  }

  start(): void {
    window.addEventListener("hashchange", () => this.route());
    window.addEventListener("keydown", (event) => this.key(event));
    this.connection.onstate = (state) => this.lineChanged(state);
    this.connection.onmessage = (message) => this.receive(message);
    this.connection.connect();
    this.route();
  }

  send(message: ClientMessage): boolean { return this.connection.send(message); }
  get online(): boolean { return this.connection.state === "open"; }
  go(hash: string): void {
    if (location.hash === hash) this.route();
    else location.hash = hash;
  }

  /// The one microscope of the page: making it costs, so that it moves from page to page.
  microscope(): FieldView {
    if (!this.view) {
      this.view = new FieldView();
      this.view.ondrawn = (ids) => { for (const frame of ids) this.send({ type: "ack", frame }); };
      if (this.scene) this.view.describe(this.scene);
      if (this.frame) this.view.show(this.frame);
    }
    return this.view;
  }

  /// A message for people at the top of the page; stays until closed or replaced by one with the same code.
  notify(level: "info" | "warn" | "danger", code: string, text: string): void {
    this.dropNotice(code);
    const box = h("div", { class: `warning ${level}`, "data-code": code }, icon[level](), h("span", {}, text));
    box.append(h("button", { class: "quietbutton", onclick: () => box.remove() }, "Close"));
    this.notice.append(box);
  }

  dropNotice(code: string): void {
    for (const child of [...this.notice.children]) if ((child as HTMLElement).dataset.code === code) child.remove();
  }

  private receive(message: ServerMessage): void {
    switch (message.type) {
      case "hello": this.hello = message; this.view?.newLine(); break;
      case "session_state": this.sessionChanged(message); break;
      case "scene":
        this.scene = message;
        this.frame = null;
        this.result = null;
        this.replay = null;
        this.view?.describe(message);
        break;
      case "frame":
        this.frame = message;
        if (this.view) this.view.show(message);
        else this.send({ type: "ack", frame: message.id });
        break;
      case "result": this.result = message; break;
      case "replay_state": this.replay = message; break;
      case "error": this.notify("warn", message.code, `${message.what}${message.advice ? ` ${message.advice}` : ""}`); break;
      case "event": break;
    }
    this.page?.onmessage?.(message);
  }

  private sessionChanged(message: SessionState): void {
    this.session = message;
    if (message.in_control) this.hadControl = true;
    else if (message.controller > 0) this.hadControl = false;
    else if (this.hadControl && (message.state === "running" || message.state === "replay")) this.send({ type: "take_control" }); // back after a lost line
    this.recording.hidden = !message.recording;
    if (message.warning) this.notify("danger", "session", message.warning);
    else this.dropNotice("session");
    this.pullChanged(message.knot_test);
  }

  /** Told once and then kept up to date, unless it was closed. */
  private pullChanged(share: number | null): void {
    if (share === null) this.dropNotice("pull");
    else {
      const text = `The knot is being pulled to see what it holds: ${Math.round(100 * share)} %. You can go on meanwhile.`;
      const box = [...this.notice.children].find((child) => (child as HTMLElement).dataset.code === "pull");
      if (box) box.querySelector("span")!.textContent = text;
      else if (!this.pulling) this.notify("info", "pull", text);
    }
    this.pulling = share !== null;
  }

  private lineChanged(state: LineState): void {
    setText(this.line, kLines[state]);
    this.line.dataset.state = state;
    if (state === "lost") this.notify("danger", "line", "No connection to the trainer. The session is safe there; this page comes back by itself.");
    if (state === "open") this.dropNotice("line");
    this.page?.online?.(state);
  }

  private route(): void {
    const [name = "", ...rest] = location.hash.replace(/^#\/?/, "").split("/");
    const make = this.routes[name] ?? this.routes[""];
    this.page?.dispose?.();
    this.main.replaceChildren();
    try {
      this.page = make(this, decodeURIComponent(rest.join("/")));
    } catch (error) { // most likely no WebGL 2: the rest of the viewer works without
      this.page = { title: "Not possible here", element: h("div", { class: "page" }, h("h1", {}, "This page cannot be shown in this browser"),
        h("p", { role: "alert" }, `${(error as Error).message} A browser with WebGL 2 is needed for the microscope; tasks, sessions and results work without.`), h("a", { class: "button", href: "#/" }, "Tasks")) };
    }
    document.title = `${this.page.title} · Filum`;
    this.main.append(this.page.element);
    this.main.dataset.page = name || "tasks";
    if (this.page.focus) this.page.focus();
    else this.main.focus({ preventScroll: true });
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    const typing = target instanceof HTMLInputElement && target.type !== "range" && target.type !== "radio" && target.type !== "checkbox";
    if (event.defaultPrevented || typing || event.metaKey) return;
    if (event.key === "?") { event.preventDefault(); this.help.toggle(); return; }
    if (this.help.element.open) return;
    if (this.page?.onkey?.(event)) { event.preventDefault(); return; }
    if (event.code === "KeyM" && !event.ctrlKey && !event.altKey && !focusUses(event)) this.toggleSound();
  }

  private toggleSound(): void { this.sound.toggle(); this.showSound(); }
  private showSound(): void {
    setText(this.soundButton, this.sound.on ? "♪ Sound on" : "Sound off");
    this.soundButton.setAttribute("aria-pressed", String(this.sound.on));
  }
}
