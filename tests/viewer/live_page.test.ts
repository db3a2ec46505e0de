// The page of a running task: where Escape leads, and what is shown when no task runs.
import { LivePage } from "@viewer/ui/live_page";
import { fakeApp, scene, state } from "./pages";

let app: ReturnType<typeof fakeApp>, page: LivePage;
const text = () => page.element.querySelector(".over")!.textContent!;
beforeEach(() => { app = fakeApp(); });
afterEach(() => page.dispose());
const open = () => { page = app.show(new LivePage(app.app)); };

describe("Escape in the field", () => {
  const escape = () => { app.view.surface.focus(); return page.onkey(new KeyboardEvent("keydown", { key: "Escape" })); };

  it("leads to a button that a Space for the grip may press, and from there on to End task", () => {
    open();
    app.hear(state("loading", "s1"), scene, state("running", "s1"));
    expect(escape()).toBe(true);
    expect(document.activeElement!.textContent).toBe("To the field");
    (document.activeElement as HTMLElement).click();
    expect(document.activeElement).toBe(app.view.surface);
    expect(app.sent.some((one) => one.type === "stop")).toBe(false);
    const buttons = [...page.element.querySelectorAll("aside button")].map((one) => one.textContent);
    expect(buttons.indexOf("End task")).toBe(buttons.indexOf("To the field") + 1);
  });
  it("brings hidden panels back, which hold the way out", () => {
    open();
    app.hear(state("loading", "s1"), scene, state("running", "s1"));
    page.element.classList.add("bare");
    escape();
    expect(page.element.classList.contains("bare")).toBe(false);
  });
});
