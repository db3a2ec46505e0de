// The viewer alone in Chromium, against the make-believe trainer: what must hold for any frames, and states that are rare.
import { fieldColours, openPage, until, type Opened } from "./browser";
import { startMock } from "./mock_trainer.mjs";

type Mock = Awaited<ReturnType<typeof startMock>>;

let mock: Mock, opened: Opened;
beforeEach(async () => { mock = await startMock({ duration: 600 }); opened = await openPage(mock.address); });
afterEach(async () => { await opened.close(); await mock.close(); });

async function start(input: "demo" | "pointer"): Promise<void> {
  const { page } = opened;
  await page.click('button[data-task="knot-square"]');
  await page.check(`input[value=${input}]`);
  await page.click("button[type=submit]");
  await page.waitForSelector(".steps li");
}

const magnification = () => opened.page.locator(".optics output").first().textContent();

it("draws the scene, acknowledges frames and chooses the lowest quality without a graphics chip", async () => {
  await start("demo");
  await until(() => mock.state.acks, (acks) => acks > 10, "acknowledged frames");
  expect(await fieldColours(opened.page)).toBeGreaterThan(60);
  expect(await opened.page.textContent(".rate")).toContain("no graphics chip");
  expect(opened.trouble).toEqual([]);
});

it("shows every stereo mode, reticle and quality without an error", async () => {
  const { page, trouble } = opened;
  await start("demo");
  mock.state.hold = true; // one still frame: the expensive levels are slow on a processor
  for (const [quality, keys] of [["auto", "123"], ["medium", "123"], ["high", "1"]]) {
    await page.selectOption(".optics select", quality);
    for (const key of keys) {
      await page.locator(".surface").focus();
      await page.keyboard.press(key);
      expect(await fieldColours(page), `${quality} ${key}`).toBeGreaterThan(40);
    }
  }
  const box = async () => (await page.locator(".surface").boundingBox())!;
  await page.keyboard.press("2");
  expect((await box()).width / (await box()).height).toBeCloseTo(2, 1);
  await page.keyboard.press("1");
  expect((await box()).width / (await box()).height).toBeCloseTo(1, 1);
  await page.keyboard.press("g");
  expect(await page.locator(".reticle").first().isVisible()).toBe(false);
  expect(trouble).toEqual([]);
});

/// The trainer's desk is made believe as well: it stores one rater's marks and the estimates beside them.
it("is rated by keyboard, scale by scale", async () => {
  const { page, trouble } = opened;
  const item = (k: number) => ({ name: `lapse-${k}`, title: `Lapse ${k}`, points: ["absent", "present"], estimate: 0, value: 0, unit: "-", why: "none" });
  const scale = { source: "S", label: "estimates", most: 1, better: "fewer", items: Array.from({ length: 10 }, (_, k) => item(k)) };
  const scales = [{ ...scale, name: "one", title: "One" }, { ...scale, name: "two", title: "Two" }], stored: object[] = [];
  await page.route("**/api/ratings/s1", (route) => {
    const wish = route.request().postDataJSON() as { scale: string; rater: string; marks: object } | null;
    if (wish) stored.push({ ...wish, stored: "2026-11-27T01:00:00Z" }, { ...wish, rater: "simulator", marks: Object.fromEntries(scale.items.map((one) => [one.name, 0])), stored: "2026-11-27T01:00:00Z" });
    return route.fulfill({ json: { session: "s1", task: "t", title: "Join", scales, ratings: stored, trouble: "" } });
  });
  await page.goto(`${mock.address}#/rate/s1`);
  const first = page.locator("[data-scale=one]"), second = page.locator("[data-scale=two]");
  await page.locator("input[name=rater]").focus();
  await page.keyboard.type("R1");
  for (let k = 0; k < 10; ++k) {
    await page.keyboard.press("Tab");
    await page.keyboard.press(k === 2 ? "1" : "0");
  }
  expect(await first.locator("input:checked").evaluateAll((all) => all.map((one) => (one as HTMLInputElement).value).join(""))).toBe("0010000000");
  await page.keyboard.press("ArrowDown");
  expect(await first.locator("[data-item=lapse-9] input:checked").inputValue(), "arrows choose as well").toBe("1");
  await page.keyboard.press("Enter");
  await page.waitForSelector("[data-scale=one] .given tbody tr");
  expect(await first.locator(".given tr.sum td").allTextContents()).toEqual(["2", "0", ""]);
  expect(stored.length, "one scale is stored").toBe(2);
  expect(await second.locator(".given table").count()).toBe(0);
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  expect(stored.length, "half a form is not stored").toBe(2);
  expect(trouble).toEqual([]);
});

it("leads raters past points, verdict, code and what the simulator found", async () => {
  const { page, trouble } = opened;
  await page.goto(`${mock.address}#/sessions`);
  await page.click("a[href='#/rating']");
  await page.waitForSelector(".sessions tr[data-session]");
  expect(await page.locator("tr[data-session]").evaluateAll((all) => all.map((one) => (one as HTMLElement).dataset.session)), "what is not scored has no form").toEqual(["s1"]);
  const list = (await page.textContent("main"))!;
  for (const told of ["89", "passed", "A17"]) expect(list, told).not.toContain(told);
  await page.click("a[href='#/watch/s1']");
  await page.waitForSelector(".replay a[href='#/rate/s1']");
  await until(() => page.textContent(".transport .time"), (text) => (text ?? "").includes("/ 10:00"), "the recording is there");
  expect(await page.locator(".events, .timeline span, a[href^='#/result']").count()).toBe(0);
  await page.goto(`${mock.address}#/replay/s1`);
  await page.waitForSelector(".events li"); // the same recording, as trainers see it
  expect(trouble).toEqual([]);
});

it("zooms and focuses by keyboard within its range", async () => {
  const { page } = opened;
  await start("demo");
  for (let i = 0; i < 20; ++i) await page.keyboard.press("+");
  expect(await magnification()).toBe("40.0×");
  for (let i = 0; i < 40; ++i) await page.keyboard.press("-");
  expect(await magnification()).toBe("5.0×");
  await page.keyboard.press("0");
  expect(await magnification()).toBe("8.0×");
});

it("sends poses of the active hand from the mouse, and of both hands from the keyboard", async () => {
  const { page } = opened;
  await start("pointer");
  await page.locator(".surface").focus();
  const last = (tool: number) => mock.state.pointers.filter((one: { tool: number }) => one.tool === tool).at(-1) as { position: number[]; grip: number; quaternion: number[]; buttons: number } | undefined;
  await until(() => last(0) !== undefined && last(1) !== undefined, Boolean, "poses of both hands");
  const first = [last(0)!, last(1)!];
  await page.keyboard.down("d"); // left hand to the right
  await until(() => last(0)!.position[0], (x) => x > first[0].position[0] + 1e-4, "left hand by D");
  await page.keyboard.up("d");
  await page.keyboard.down("ArrowUp"); // right hand away
  await until(() => last(1)!.position[1], (y) => y > first[1].position[1] + 1e-4, "right hand by arrow");
  await page.keyboard.up("ArrowUp");

  const box = (await page.locator(".surface").boundingBox())!;
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForTimeout(300);
  const still = last(0)!, before = last(1)!.position[0];
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2, { steps: 8 });
  await until(() => last(1)!.position[0], (x) => Math.abs(x - before - (80 * 0.025) / box.width) < 3e-4, "right hand follows the mouse 1:1 in the focal plane");
  expect(last(0)!.position).toEqual(still.position);

  await page.keyboard.press("Tab");
  const parked = last(1)!;
  await page.mouse.down();
  await until(() => last(0)!.grip, (grip) => grip === 1, "left grip closes while held");
  await page.mouse.up();
  await until(() => last(0)!.grip, (grip) => grip === 0, "and opens when let go");
  const depth = last(0)!.position[2];
  await page.mouse.wheel(0, -300);
  await until(() => last(0)!.position[2], (z) => z > depth + 3e-4, "wheel is depth");
  const before_turn = last(0)!.quaternion;
  await page.keyboard.down("q");
  await until(() => last(0)!.quaternion, (q) => Math.abs(q.reduce((sum, v, k) => sum + v * before_turn[k], 0)) < 0.999, "Q rolls");
  await page.keyboard.up("q");
  await page.keyboard.down("c");
  await until(() => last(0)!.buttons, (buttons) => buttons === 2, "C is the cut button");
  await page.keyboard.up("c");
  await until(() => last(0)!.buttons, (buttons) => buttons === 0, "and goes up again");
  expect(last(1)!.position).toEqual(parked.position);
});

it("answers frames that a new scene overtakes before they are drawn, and goes on", async () => {
  await start("demo");
  for (let k = 0; k < 3; ++k) {
    const acks = mock.state.acks;
    mock.nextScene();
    await until(() => mock.state.acks, (now) => now > acks + 4, "frames are drawn again");
  }
});

it("comes back by itself after the line was dropped, and goes on steering", async () => {
  const { page } = opened;
  await start("pointer");
  mock.dropSockets();
  await page.waitForSelector(".notices [data-code=line]");
  await page.waitForSelector(".line[data-state=open]");
  await page.waitForSelector(".notices [data-code=line]", { state: "detached" });
  const acks = mock.state.acks;
  await until(() => mock.state.acks, (now) => now > acks + 5, "frames are drawn again");
});

it("warns by words, signs and outline", async () => {
  const { page } = opened;
  await start("demo");
  const danger = page.locator(".warnings .danger");
  await danger.waitFor();
  const seen = await danger.evaluate((one) => {  // at once: warnings come and go with the frames
    const styles = [...one.parentElement!.children].map((each) => getComputedStyle(each).borderTopStyle + getComputedStyle(each).backgroundImage);
    return { text: one.textContent, signs: one.querySelectorAll("svg").length, styles };
  });
  expect(seen.text).toContain("Stop");
  expect(seen.signs).toBe(1);
  expect(new Set(seen.styles).size).toBe(seen.styles.length);
});

it("is used from start to replay with the keyboard alone, and shows where the focus is", async () => {
  const { page } = opened;
  await opened.close();
  await mock.close();
  mock = await startMock({ duration: 4 });
  opened = await openPage(mock.address);
  const { page: fresh } = opened;
  expect(page).not.toBe(fresh);
  const focused = () => fresh.evaluate(() => {
    const one = document.activeElement as HTMLElement;
    const style = getComputedStyle(one);
    return { text: (one.getAttribute("aria-label") ?? one.textContent ?? "").trim(), task: one.dataset.task ?? "", ring: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2, href: one.getAttribute("href") ?? "", value: (one as HTMLInputElement).value ?? "" };
  });
  const tabTo = async (wanted: (one: Awaited<ReturnType<typeof focused>>) => boolean, what: string) => {
    for (let i = 0; i < 40; ++i) {
      const now = await focused();
      if (wanted(now)) { expect(now.ring, `focus is visible on ${what}`).toBe(true); return; }
      await fresh.keyboard.press("Tab");
    }
    throw new Error(`Tab never reached ${what}`);
  };
  await fresh.waitForSelector("button.card");
  await fresh.keyboard.press("?");
  await fresh.waitForSelector("dialog.help[open]");
  await fresh.keyboard.press("Escape");
  await tabTo((one) => one.task === "knot-square", "the task");
  await fresh.keyboard.press("Enter");
  await fresh.waitForSelector("dialog.start[open]");
  await fresh.keyboard.press("ArrowDown"); // from pointer to demonstration
  expect((await focused()).value).toBe("demo");
  await fresh.keyboard.press("Enter");
  await fresh.waitForSelector(".endcard .primary");
  expect(mock.state.starts).toEqual([{ type: "start", task: "knot-square", input: "demo" }]);
  await fresh.keyboard.press("Enter"); // the link to the result has the focus
  await fresh.waitForSelector(".score tbody tr");
  await tabTo((one) => one.href.startsWith("#/replay/") && one.text === "Replay", "the replay link");
  await fresh.keyboard.press("Enter");
  await fresh.waitForSelector(".transport .play");
  const time = () => fresh.locator(".scrub").inputValue().then(Number);
  await until(async () => Number(await fresh.locator(".scrub").getAttribute("max")), (max) => max > 3, "recording opens");
  await fresh.keyboard.press("ArrowRight");
  await until(time, (now) => Math.abs(now - 1) < 0.05, "one second on");
  await fresh.keyboard.press("End");
  await until(time, (now) => now > 3.9, "to the end");
  await fresh.keyboard.press("Home");
  await until(time, (now) => now === 0, "to the start");
  await fresh.keyboard.press("Enter"); // the play button has the focus
  await until(time, (now) => now > 0.5, "plays");
  expect(opened.trouble).toEqual([]);
});

it("keeps tasks and sessions usable where the browser cannot draw in three dimensions", async () => {
  const { page } = opened;
  await page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
  await page.goto(`${mock.address}#/live`);
  await page.reload();
  await page.waitForSelector("[role=alert]");
  expect(await page.textContent("main [role=alert]")).toContain("WebGL 2");
  await page.click("a[href='#/sessions']");
  await page.waitForSelector("tr[data-session]");
  expect(await page.locator("tr[data-session]").count()).toBe(2);
});
