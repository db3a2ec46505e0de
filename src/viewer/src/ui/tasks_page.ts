// First page: the tasks with their pictures, and how to start one.
import type { App, Page } from "../app";
import type { InputKind, ServerMessage, Start, TaskInfo } from "../messages";
import { sessions } from "../net/api";
import { clear, h, setText } from "./dom";
import { taskPicture } from "./pictures";
import { askBeforeReplays, mayEndTask } from "./running_task";
import { runningNow, sessionTable } from "./sessions_page";

const kInputs: Record<InputKind, [string, string]> = {
  pointer: ["Mouse, keyboard or gamepad", "You move both instruments from this browser."],
  demo: ["Demonstration", "Watch how it is done. Nothing is scored in your name."],
  device: ["Attached instruments", "The sensor forceps on this trainer."],
};

export class TasksPage implements Page {
  readonly title = "Tasks";
  readonly element = h("div", { class: "page tasks" });
  private readonly chapters = h("div", {});
  private readonly running = h("div", { class: "running" });
  private readonly recent = h("section", { class: "recent" });
  private listed: string | null = null; // what ran when the latest sessions were asked for
  private readonly dialog = h("dialog", { class: "start", "aria-labelledby": "start-title" });

  constructor(private readonly app: App) {
    askBeforeReplays(app, this.element);
    this.element.append(h("h1", {}, "Choose a task"), this.running, this.chapters, this.recent, this.dialog);
    this.showTasks();
    this.showRunning();
    void this.showRecent();
  }

  onmessage(message: ServerMessage): void {
    if (message.type === "hello") this.showTasks();
    if (message.type !== "session_state") return;
    this.showRunning();
    if (runningNow(this.app) !== this.listed) void this.showRecent();
  }

  private showTasks(): void {
    clear(this.chapters);
    const tasks = this.app.hello?.tasks;
    if (!tasks) { this.chapters.append(h("p", { class: "quiet" }, "Waiting for the trainer…")); return; }
    for (const chapter of new Set(tasks.map((task) => task.chapter))) {
      this.chapters.append(h("section", { "aria-label": chapter }, h("h2", {}, chapter), this.cards(tasks.filter((task) => task.chapter === chapter))));
    }
  }

  private cards(tasks: TaskInfo[]): HTMLElement {
    const cards = h("ul", { class: "cards" });
    for (const task of tasks) {
      const button = h("button", { class: "card", "data-task": task.name, onclick: () => this.open(task) },
        taskPicture(task.picture, task.title), h("span", { class: "cardtitle" }, task.title), h("span", { class: "summary" }, task.summary),
        task.demonstration ? h("span", { class: "tag" }, "demonstration only") : null);
      cards.append(h("li", {}, button));
    }
    return cards;
  }

  /// The list is a convenience here; where it cannot be had the sessions page says why.
  private async showRecent(): Promise<void> {
    this.listed = runningNow(this.app);
    const list = await sessions().then((answer) => answer.sessions, () => []);
    if (list.length > 0) this.recent.replaceChildren(h("h2", {}, "Latest sessions"), sessionTable(list.slice(0, 5), this.app));
  }

  private showRunning(): void {
    clear(this.running);
    const session = this.app.session;
    if (!session || session.state === "idle" || session.state === "ended") return;
    const task = this.app.hello?.tasks.find((one) => one.name === session.task);
    const what = session.state === "replay" ? "A replay is open" : `Running now: ${task?.title ?? session.task}`;
    const who = session.in_control ? "" : session.controller > 0 ? " (controlled from another browser)" : "";
    this.running.append(h("span", {}, what + who), h("a", { class: "button", href: "#/live" }, session.in_control ? "Continue" : "Watch"));
  }

  private choices(task: TaskInfo): HTMLElement[] {
    const offered = this.app.hello?.inputs ?? [];
    const allowed = offered.filter((input) => (input === "demo" ? task.shown : !task.demonstration));
    return (Object.keys(kInputs) as InputKind[]).map((input) => {
      const usable = allowed.includes(input);
      const radio = h("input", { type: "radio", name: "input", value: input, disabled: !usable, checked: usable && input === allowed[0] });
      return h("label", { class: usable ? "choice" : "choice off" }, radio, h("span", {}, h("strong", {}, kInputs[input][0]), h("br"),
        usable ? kInputs[input][1] : input === "demo" ? "There is none of this task yet." : task.demonstration ? "This task is shown only." : "Nothing of this kind is attached."));
    });
  }

  private async begin(wish: Start, trouble: HTMLElement): Promise<void> {
    const { app } = this;
    if (!(await mayEndTask(app, this.element))) return;
    if (!app.send(wish)) { setText(trouble, "No connection to the trainer. Try again in a moment."); return; }
    app.result = null;
    app.replay = null; // one that another browser left open is over with this
    this.dialog.close();
    app.go("#/live");
  }

  private open(task: TaskInfo): void {
    const { app, dialog } = this;
    const code = h("input", { type: "text", maxlength: 32, pattern: "[A-Za-z0-9_\\-]*", autocomplete: "off", placeholder: "e.g. A17" });
    const others = app.session !== null && app.session.controller > 0 && !app.session.in_control;
    const over = h("input", { type: "checkbox", name: "take_over" });
    const dial = h("input", { type: "range", name: "stiffness", min: -1, max: 1, step: 0.05, value: 0, "aria-label": "Stiffness of the brain" }), turned = h("output", {}, "as in the model");
    const stiffness = () => +(10 ** Number(dial.value)).toPrecision(2); // as many steps softer as stiffer
    dial.addEventListener("input", () => setText(turned, stiffness() === 1 ? "as in the model" : `${stiffness()} times the model's`));
    const exam = h("input", { type: "checkbox", name: "exam" });
    const trouble = h("p", { class: "trouble", role: "alert" }, "");
    const form = h("form", { method: "dialog", novalidate: true, onsubmit: (event: Event) => {
      event.preventDefault();
      const input = (form.querySelector("input[name=input]:checked") as HTMLInputElement | null)?.value as InputKind | undefined;
      if (!input) { setText(trouble, "Choose how the instruments are moved."); return; }
      if (!code.checkValidity()) { setText(trouble, "The code may hold letters, digits, - and _ only."); code.focus(); return; }
      void this.begin({ type: "start", task: task.name, input, ...(code.value && !code.disabled ? { code: code.value } : {}), ...(task.dial && stiffness() !== 1 ? { stiffness: stiffness() } : {}), ...(exam.checked ? { exam: true } : {}), ...(others ? { take_over: over.checked } : {}) }, trouble);
    } },
      h("fieldset", {}, h("legend", {}, "Who moves the instruments?"), ...this.choices(task)),
      h("label", { class: "line-input" }, "Trainee code (no name; may stay empty)", code),
      task.dial ? h("label", { class: "line-input" }, h("span", {}, "Stiffness of the brain: ", turned), dial) : null,
      h("label", { class: "choice" }, exam, h("span", {}, h("strong", {}, "Exam"), h("br"), "Without hints, guides and colours on the tissue; the recording says so.")),
      others ? h("label", { class: "choice" }, over, h("span", {}, h("strong", {}, "Take over control"), h("br"), "Another browser is in control now; its task ends.")) : null,
      trouble,
      h("div", { class: "buttons" }, h("button", { type: "button", class: "quietbutton", onclick: () => dialog.close() }, "Cancel"),
        h("button", { type: "submit", class: "primary" }, "Start")));
    const demo = form.querySelector<HTMLInputElement>("input[value=demo]")!; // shown to whoever watches, done by nobody
    const codeOff = () => { code.disabled = demo.checked; };
    form.addEventListener("change", codeOff);
    codeOff();
    dialog.replaceChildren(h("div", { class: "starthead" }, taskPicture(task.picture, task.title),
      h("div", {}, h("h1", { id: "start-title" }, task.title), h("p", {}, task.summary))), form);
    dialog.showModal();
    (dialog.querySelector("input[name=input]:checked") as HTMLElement | null)?.focus();
  }

  dispose(): void { if (this.dialog.open) this.dialog.close(); }
}
