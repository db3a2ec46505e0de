// The whole program: the real trainer, the built viewer, Chromium. FILUM_BIN names the program.
import { cuttableLine, fieldColours, hasTrainer, openPage, startTrainer, trainerProgram, until, type Opened, type Trainer } from "./browser";

if (!hasTrainer) console.warn(`\n*** The tests of the whole program are SKIPPED: FILUM_BIN=${trainerProgram || "(not set)"} is no program. ***\n`);

const kWholeTask = 1200; // [s], a demonstration on a busy machine without a graphics chip

describe.skipIf(!hasTrainer)("trainer", () => {
  let trainer: Trainer, opened: Opened;
  beforeEach(async () => { trainer = await startTrainer(); });
  afterEach(async () => { await opened?.close(); await trainer.stop(); });

  async function start(input: "demo" | "pointer", task = "knot-square"): Promise<void> {
    const { page } = opened;
    await page.click(`button[data-task="${task}"]`);
    await page.check(`input[value=${input}]`);
    await page.click("button[type=submit]");
    await page.waitForSelector(".steps li");
    await until(opened.frame, (frame) => frame !== undefined && frame.time > 0, "the first frames");
  }

  it("shows a demonstration from the task list to the replay", { timeout: 1000 * (kWholeTask + 300) }, async () => {
    opened = await openPage(trainer.address);
    const { page } = opened;
    await start("demo", "knot-throw");
    expect(await page.locator(".steps li").count()).toBeGreaterThan(3);
    expect(await fieldColours(page)).toBeGreaterThan(60);
    const seen = new Set<number>();
    await until(() => { const step = opened.frame()?.task?.step_index; if (step !== undefined) seen.add(step); return page.locator(".endcard").count(); },
      (ended) => ended > 0, "the demonstration ends", kWholeTask);
    expect(seen.size, "steps are recognised one after the other").toBeGreaterThan(3);
    await page.click(".endcard .primary");

    await page.waitForSelector(".score tbody tr");
    const reasons = await page.locator(".score tbody tr td:last-child").allTextContents();
    expect(reasons.length).toBeGreaterThan(4);
    for (const reason of reasons) expect(reason.length, "every line has its reason").toBeGreaterThan(3);
    expect(await page.textContent(".knot")).toContain("Overhand knot");
    await page.waitForSelector(".chart .uplot canvas");
    await page.waitForSelector(".pathplot canvas");

    await page.click(".resulthead a:has-text('Replay')");
    const end = await until(async () => Number(await page.locator(".scrub").getAttribute("max")), (max) => max > 3, "the recording opens");
    const scrub = page.locator(".scrub"), box = (await scrub.boundingBox())!;
    await page.mouse.click(box.x + 0.5 * box.width, box.y + box.height / 2);
    await until(() => opened.frame()!.time, (time) => Math.abs(time - end / 2) < 0.05 * end, "scrubbing shows the middle");
    const middle = JSON.stringify(opened.frame()!.tools[1].pose.position);
    await page.mouse.click(box.x + 0.1 * box.width, box.y + box.height / 2);
    await until(() => opened.frame()!.time, (time) => time < 0.2 * end, "and the beginning");
    expect(JSON.stringify(opened.frame()!.tools[1].pose.position)).not.toBe(middle);
    const from = opened.frame()!.time;
    await page.click(".play");
    await until(() => opened.frame()!.time, (time) => time > from + 0.5, "it plays");
    expect(opened.trouble).toEqual([]);
  });

  it("lets the pointer move and close the instruments, and scores what was done", async () => {
    opened = await openPage(trainer.address);
    const { page } = opened;
    await start("pointer");
    const tool = (i: number) => opened.frame()!.tools[i];
    const box = (await page.locator(".surface").boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await until(() => tool(0).input_valid && tool(1).input_valid, (valid) => valid, "the trainer hears the pointer");
    expect(await page.textContent(".hand")).toContain("Needle holder");
    const right = tool(1).pose.position[0], left = tool(0).pose.position[0];
    await page.mouse.move(box.x + box.width / 2 - 150, box.y + box.height / 2, { steps: 15 });
    await until(() => tool(1).pose.position[0], (x) => x < right - 2e-3, "the needle holder follows the mouse");
    expect(Math.abs(tool(0).pose.position[0] - left)).toBeLessThan(5e-4);
    await page.keyboard.press("Tab");
    const open = tool(0).grip_angle;
    await page.mouse.down();
    await until(() => tool(0).grip_angle, (angle) => angle < 0.5 * open, "the forceps close");
    await until(() => tool(0).grip_force, (force) => force > 0, "and squeeze");
    await page.mouse.up();
    await until(() => tool(0).grip_angle, (angle) => angle > 0.5 * open, "and open again");
    await page.click(".end");
    await page.click(".endcard .primary");
    await page.waitForSelector(".score tbody tr");
    expect(await page.textContent(".verdict")).toContain("Not");
    expect(opened.trouble).toEqual([]);
  });

  it("begins with the needle to be taken in the picture, and says how much is magnified", async () => {
    opened = await openPage(trainer.address);
    const { page } = opened;
    await start("pointer", "anastomosis-8");
    const needle = opened.frame()!.needle!.pose.position;
    const magnification = await until(async () => Number.parseFloat((await page.locator(".mag").first().textContent())!), (m) => m < 20, "the field widens to the needle");
    expect(await page.locator(".optic output").first().textContent()).toBe(`${magnification.toFixed(1)}×`);
    const radius = 200 / magnification / 2; // [mm], of the field: 200 mm at once
    expect(1000 * Math.hypot(needle[0], needle[1])).toBeLessThan(radius);
  });

  it("offers a demonstration only where there is one", async () => {
    opened = await openPage(trainer.address);
    const { page } = opened;
    for (const [task, shown] of [["needle-course", false], ["knot-square", true]] as const) {
      await page.click(`button[data-task=${task}]`);
      await page.waitForSelector("dialog.start[open]");
      expect(await page.isEnabled("input[value=demo]")).toBe(shown);
      expect(await page.isChecked("input[value=pointer]")).toBe(true);
      await page.keyboard.press("Escape");
      await page.waitForSelector("dialog.start[open]", { state: "detached" });
    }
    expect(opened.trouble).toEqual([]);
  });

  it("is used with the keyboard alone", async () => {
    opened = await openPage(trainer.address);
    const { page } = opened;
    const active = () => page.evaluate(() => { const one = document.activeElement as HTMLElement; return `${one.dataset.task ?? ""} ${one.textContent ?? ""}`; });
    const tabTo = async (text: string) => {
      await until(async () => { const now = await active(); if (!now.includes(text)) await page.keyboard.press("Tab"); return now; }, (now) => now.includes(text), `Tab reaches ${text}`);
    };
    await page.waitForSelector("button.card");
    await tabTo("knot-square");
    await page.keyboard.press("Enter");
    await page.waitForSelector("dialog.start[open]");
    await page.keyboard.press("Enter"); // pointer is the first choice
    await page.waitForSelector(".steps li");
    await until(opened.frame, (frame) => frame !== undefined && frame.tools[0].input_valid, "the trainer hears the keyboard");
    const at = () => opened.frame()!.tools.map((tool) => tool.pose.position);
    const before = at();
    await page.keyboard.down("w");
    await page.keyboard.down("ArrowDown");
    await until(at, (now) => now[0][1] > before[0][1] + 1e-3 && now[1][1] < before[1][1] - 1e-3, "both hands move at once");
    await page.keyboard.up("w");
    await page.keyboard.up("ArrowDown");
    await page.keyboard.down("b");
    await until(() => opened.frame()!.tools[1].grip_force, (force) => force > 0, "B closes the needle holder");
    await page.keyboard.up("b");
    await page.keyboard.press("Escape");
    await tabTo("End task");
    await page.keyboard.press("Enter");
    await page.waitForSelector(".endcard .primary");
    await page.keyboard.press("Enter");
    await page.waitForSelector(".score tbody tr");
  });

  it("goes on after the line to the trainer was cut, still in control", async () => {
    const line = await cuttableLine(trainer.address);
    try {
      opened = await openPage(line.address);
      const { page } = opened;
      await start("pointer");
      line.cut();
      await page.waitForSelector(".line[data-state=lost], .line[data-state=connecting], .notices [data-code=line]");
      await page.waitForSelector(".line[data-state=open]");
      await until(() => opened.received.filter((one) => one.type === "session_state").at(-1), (state) => state?.state === "running" && state.in_control === true, "control is back");
      const time = opened.frame()!.time;
      await until(() => opened.frame()!, (frame) => frame.time > time + 0.2 && frame.tools[1].input_valid, "the task goes on, and hears the pointer");
      const before = opened.frame()!.tools[1].pose.position[1];
      await page.locator(".surface").focus();
      await page.keyboard.down("ArrowUp");
      await until(() => opened.frame()!.tools[1].pose.position[1], (y) => y > before + 1e-3, "the hand moves");
      await page.keyboard.up("ArrowUp");
    } finally {
      await line.close();
    }
  });

  it("lets a second browser watch and take over openly", async () => {
    opened = await openPage(trainer.address);
    await start("pointer");
    const other = await openPage(`${trainer.address}#/live`);
    try {
      await other.page.waitForSelector(".steps li");
      await until(other.frame, (frame) => frame !== undefined && frame.time > 0, "the second browser sees frames");
      expect(await other.page.textContent(".hand")).toContain("Watching");
      await other.page.click(".take");
      await until(() => opened.received.filter((one) => one.type === "session_state").at(-1)!.in_control, (mine) => mine === false, "the first has lost control");
      await until(() => opened.page.textContent(".hand"), (text) => (text ?? "").includes("Watching"), "and says so");
    } finally {
      await other.close();
    }
  });
});
