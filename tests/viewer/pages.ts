// What a page needs of the app and of the microscope, without a screen; what the page sends is kept.
import type { App } from "@viewer/app";
import type { Result, Scene, ServerMessage, SessionState } from "@viewer/messages";
import { frameAt, kScene, resultOf } from "./sample_frames.mjs";

export function fakeView() {
  const stage = { floorHeight: 0 }, quality = { current: { name: "high" }, automatic: false, software: false, choose: () => {} };
  const surface = document.createElement("div"), element = document.createElement("div");
  surface.tabIndex = 0;
  element.append(surface);
  return {
    element, surface, reticleShown: true, guidesShown: false, onoptics: () => {}, onclick: () => {}, metresPerPixel: 1e-5,
    microscope: { optics: { magnification: 8, focus: 0, eyeDistance: 22, tilt: 0 }, stage, stereo: "mono", quality, rendererName: "" },
    start: () => {}, stop: () => {}, mark: () => {}, zoom: () => {}, look: () => {}, picture: () => "", redraw: () => {}, showGuides: () => {},
  };
}

export const state = (name: SessionState["state"], session: string | null, more: Partial<SessionState> = {}): SessionState => ({
  type: "session_state", state: name, task: "knot-square", input: "pointer", pointer: true, controller: 1, in_control: true, clients: 1, recording: false, exam: false, session, warning: "", knot_test: null, ...more });
export const scene = kScene as unknown as Scene;
export const replayOf = (session: string, time = 0) => ({ type: "replay_state" as const, session, time, duration: 30, ready: 30, playing: false });
export const resultFor = (session: string, more: Partial<Result> = {}) => ({ ...(resultOf(session, 30) as unknown as Result), ...more });
export const frame = (time = 1) => frameAt(time, 1, 30) as unknown as Extract<ServerMessage, { type: "frame" }>;

/// Keeps what messages say as the app does, and hands them to the page.
export function fakeApp() {
  const sent: Record<string, unknown>[] = [], gone: string[] = [], dropped: string[] = [], view = fakeView();
  let page: { onmessage?(message: ServerMessage): void } | null = null;
  const app = {
    online: true, hello: {} as unknown, session: null as SessionState | null, scene: null as unknown, frame: null as unknown, result: null as unknown, replay: null as unknown,
    sound: { play: () => {} }, dropNotice: (code: string) => { dropped.push(code); }, microscope: () => view, go: (hash: string) => { gone.push(hash); }, send: (message: Record<string, unknown>) => { sent.push(message); return true; },
  };
  return {
    app: app as unknown as App, sent, gone, dropped, view,
    show<P extends { element: HTMLElement; onmessage?(message: ServerMessage): void }>(made: P): P { page = made; document.body.replaceChildren(made.element); return made; },
    hear(...messages: ServerMessage[]): void {
      for (const message of messages) {
        if (message.type === "session_state") app.session = message;
        if (message.type === "scene") Object.assign(app, { scene: message, frame: null, result: null, replay: null });
        if (message.type === "frame") app.frame = message;
        if (message.type === "result") app.result = message;
        if (message.type === "replay_state") app.replay = message;
        page?.onmessage?.(message);
      }
    },
  };
}
