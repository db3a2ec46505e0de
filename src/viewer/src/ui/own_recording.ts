// What the pages of one recording share: whether it is theirs that the trainer shows, and what is said where opening it was refused.
// A trainer tells every browser what it does, so that a page also hears of other sessions.
import type { App } from "../app";
import type { ServerMessage } from "../messages";
import { h } from "./dom";

export const kClosed = "This recording is not open any more: the trainer does something else.";

/// True while scene and frames are those of recording `id`.
export function showsRecording(app: App, id: string): boolean {
  const { session } = app;
  return session !== null && session.session === id && (session.state === "loading" || session.state === "replay");
}

/// Whether a message belongs to recording `id`; of scene and frame the state that comes before them tells.
export function isOf(app: App, id: string, message: ServerMessage): boolean {
  if (message.type === "result" || message.type === "replay_state") return message.session === id;
  return (message.type !== "scene" && message.type !== "frame") || showsRecording(app, id);
}

/// Why the recording is not shown, and the way on: `open` asks for it again. `more`: other ways.
export function refusalCard(what: string, way: string, open: () => void, ...more: HTMLElement[]): HTMLElement {
  return h("div", { class: "card endcard", role: "alert" }, h("p", {}, what),
    h("div", { class: "buttons" }, h("button", { class: "primary", onclick: open }, way), ...more, h("a", { class: "button", href: "#/sessions" }, "All sessions")));
}

/// A request of the page that was refused. Where another browser is in control, taking it is the way; that it ends a task there is said.
export function errorCard(app: App, message: { code: string; what: string }, open: () => void, ...more: HTMLElement[]): HTMLElement {
  if (message.code !== "not-in-control") return refusalCard(message.what, "Try again", open, ...more);
  const running = app.session?.state === "running" || app.session?.state === "loading";
  const text = running ? `${message.what} Its task ends if you take control.` : message.what;
  return refusalCard(text, "Take control", () => { app.send({ type: "take_control" }); app.dropNotice(message.code); open(); }, ...more);
}
