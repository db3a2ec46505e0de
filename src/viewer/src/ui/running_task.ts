// Asked before this browser ends a task that is running.
import type { App } from "../app";
import { h } from "./dom";

const kOpensReplay = 'a[href^="#/replay/"], a[href^="#/watch/"], a[href^="#/moments/"]';

/// What another browser controls is not ended from here; what nobody does (this page was loaded anew) is.
function wouldEnd({ session }: App): boolean {
  return session?.state === "running" && (session.in_control || session.controller === 0);
}

/// True where nothing would be ended, or where it was agreed to. The question is part of `page` and goes with it.
export function mayEndTask(app: App, page: HTMLElement): Promise<boolean> {
  if (!wouldEnd(app)) return Promise.resolve(true);
  const name = app.session!.task, title = app.hello?.tasks.find((one) => one.name === name)?.title ?? name;
  const keep = h("button", { type: "button", class: "primary", onclick: () => dialog.close() }, "Cancel");
  const dialog = h("dialog", { class: "ask", role: "alertdialog", "aria-labelledby": "ask-text" },
    h("p", { id: "ask-text" }, `A task is running: ${title}. It ends now and is scored as far as it went.`),
    h("div", { class: "buttons" }, keep, h("button", { type: "button", class: "endtask", onclick: () => dialog.close("end") }, "End the task")));
  page.append(dialog);
  dialog.showModal();
  keep.focus();
  return new Promise((answer) => dialog.addEventListener("close", () => { dialog.remove(); answer(dialog.returnValue === "end"); }));
}

/// Links on `page` that open a replay ask first: a replay takes the place of the task.
export function askBeforeReplays(app: App, page: HTMLElement): void {
  page.addEventListener("click", (event) => {
    const link = (event.target as Element).closest<HTMLAnchorElement>(kOpensReplay);
    if (!link || event.ctrlKey || event.metaKey || !wouldEnd(app)) return;
    event.preventDefault();
    void goToReplay(app, page, link.getAttribute("href")!);
  });
}

export async function goToReplay(app: App, page: HTMLElement, hash: string): Promise<void> {
  if (await mayEndTask(app, page)) app.go(hash);
}
