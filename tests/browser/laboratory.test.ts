// The laboratory's pages with the real trainer: reconcile with progress and cancel, calibration of the forceps, analysis of a session.
import { execFileSync, spawn, type ChildProcess } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { boardProgram, feederProgram, hasTrainer, openPage, startTrainer, until, type Opened, type Trainer } from "./browser";

/// A block of 2 kPa that relaxes by half in 2 s (q' = (u - q)/tau), pressed at two rates and held.
function writeBlock(folder: string, samples: number): void {
  mkdirSync(folder, { recursive: true });
  const trials = ["a", "b", "c", "d"].map((name, i) => `  - { file: ${name}.csv, protocol: { mode: compression, rate: "${i < 2 ? 1 : 4} mm/s" }, repeat: ${i < 2 ? "A" : "B"} }`);
  writeFileSync(join(folder, "experiment.yaml"), `format: filum-experiment/1\ntitle: Relaxing block\nsource: made by the test\nrig: tissue-block
specimen: { shape: cuboid, length: "5 mm", width: "5 mm", height: "5 mm" }\nmodel: { file: brain/linear, free: [youngs_modulus] }\nchannels:
  - { name: time, column: t, unit: s }\n  - { name: displacement, column: u, unit: mm, kind: input }\n  - { name: force, column: F, unit: mN, kind: output, noise: "0.02 mN" }\ntrials:\n${trials.join("\n")}\n`);
  let seed = 1;
  const noise = (): number => { let sum = -6; for (let k = 0; k < 12; ++k) { seed = (seed * 1103515245 + 12345) % 2147483648; sum += seed / 2147483648; } return sum; };
  ["a", "b", "c", "d"].forEach((name, i) => {
    const step = 10 / samples, rows = ["t,u,F"];
    for (let n = 0, q = 0, last = 0; n <= samples; ++n) {
      const u = -Math.min(0.5, (i < 2 ? 1 : 4) * n * step);
      if (n > 0) q = (q * (1 - 0.25 * step) + 0.25 * step * (u + last)) / (1 + 0.25 * step);
      last = u;
      rows.push(`${(n * step).toFixed(5)},${u.toFixed(6)},${(10 * (u - 0.5 * q) + 0.02 * noise()).toFixed(6)}`);
    }
    writeFileSync(join(folder, `${name}.csv`), `${rows.join("\n")}\n`);
  });
}

describe.skipIf(!hasTrainer)("laboratory", () => {
  let trainer: Trainer, opened: Opened, data: string;
  beforeEach(() => { data = mkdtempSync(join(tmpdir(), "filum-data-")); });
  afterEach(async () => { await opened?.close(); await trainer?.stop(); rmSync(data, { recursive: true, force: true }); });

  it("reconciles measurements by keyboard alone, shows the report, and stops when asked", { timeout: 600_000 }, async () => {
    writeBlock(join(data, "block"), 400);
    writeBlock(join(data, "long"), 80_000);
    trainer = await startTrainer("--datasets", data);
    opened = await openPage(`${trainer.address}#/laboratory`);
    const { page } = opened;
    const tabTo = (label: string) => until(async () => {
      const now = await page.evaluate(() => `${document.activeElement?.getAttribute("aria-label") ?? ""} ${document.activeElement?.textContent ?? ""}`);
      if (!now.includes(label)) await page.keyboard.press("Tab");
      return now;
    }, (now) => now.includes(label), `Tab reaches ${label}`);
    await page.waitForSelector("[data-start=block]");
    await tabTo("Reconcile block");
    await page.keyboard.press("Enter");
    await page.waitForSelector("[data-report=block]");
    expect(await page.textContent("tr:has([data-report=block])")).toContain("viscoelastic-relaxation");
    await tabTo("Report of block");
    await page.keyboard.press("Enter");
    const report = page.frameLocator("iframe.document");
    expect(await report.locator("body").textContent()).toContain("viscoelastic-relaxation");
    expect(await page.evaluate(async () => (await fetch("/documents/reconcile/block/model.yaml")).text())).toContain("format: filum-model/1");

    await page.click("[data-start=long]");
    await page.waitForSelector("progress:not([hidden])");
    await page.locator(".cancel").press("Enter");
    await until(() => page.textContent(".reconcile > [role=status]"), (text) => (text ?? "").includes("cancelled"), "it is cancelled");
    expect(await page.locator("[data-report=long]").count()).toBe(0);
    expect(opened.trouble).toEqual([]);
  });

  it("takes a folder of measurements that is chosen in the browser", { timeout: 300_000 }, async () => {
    const mine = join(data, "mine"), kept = join(data, "kept");
    writeBlock(join(mine, "block"), 400);
    mkdirSync(kept);
    trainer = await startTrainer("--datasets", kept);
    opened = await openPage(`${trainer.address}#/laboratory`);
    const { page } = opened;
    await page.setInputFiles("#measurements", join(mine, "block"));
    await page.waitForSelector("[data-start=block]");
    for (const name of ["experiment.yaml", "a.csv", "d.csv"]) expect(readFileSync(join(kept, "block", name), "utf8")).toBe(readFileSync(join(mine, "block", name), "utf8"));
    await page.setInputFiles("#measurements", join(mine, "block"));
    await until(() => page.textContent(".upload [role=status]"), (text) => (text ?? "").includes("which is there already"), "a second one of that name is refused");
    expect(readdirSync(kept)).toEqual(["block"]);
    expect(opened.trouble).toEqual([]);
  });

  it("analyses a recorded session on its result page, and studies all on a page of their own", { timeout: 600_000 }, async () => {
    trainer = await startTrainer("--datasets", data);
    opened = await openPage(trainer.address);
    const { page } = opened;
    await page.click('button[data-task="tip-hold"]');
    await page.check("input[value=demo]");
    await page.click("button[type=submit]");
    await until(opened.frame, (frame) => frame !== undefined && frame.time > 16, "some seconds of the demonstration", 300);
    await page.click(".end");
    await page.click(".endcard .primary");
    await page.waitForSelector(".analysis .analyse");
    await page.click(".analyse");
    const body = page.frameLocator("iframe.document").locator("body");
    const text = (await body.textContent()) ?? "";
    for (const word of ["Tremor", "Smoothness", "6-12"]) expect(text.toLowerCase(), text.slice(0, 400)).toContain(word.toLowerCase());
    expect(await page.frameLocator("iframe.document").locator("svg").count()).toBeGreaterThan(0);
    // The study, by keyboard alone: a demonstration is left out unless it is asked for.
    await page.focus("nav a[href='#/study']");
    await page.keyboard.press("Enter");
    const role = page.locator(".study tbody select");
    await role.waitFor();
    expect(await role.inputValue()).toBe("out");
    await page.focus(".study .primary");
    await page.keyboard.press("Enter");
    await until(() => page.textContent(".study [role=status] >> nth=-1"), (said) => (said ?? "").includes("at least one"), "nothing to study is said");
    await role.focus();
    await page.keyboard.press("Home"); // the first: it counts
    await page.focus(".study .primary");
    await page.keyboard.press("Enter");
    const study = (await page.frameLocator(".study iframe").locator("body").textContent()) ?? "";
    for (const word of ["tip-hold", "across people", "fewer than 4 people", "zero: a script has no sensor"]) expect(study).toContain(word);
    const csv = await page.evaluate(async () => (await fetch("/documents/study/sessions.csv")).text());
    expect(csv.split("\n").length).toBe(3);
    expect((await page.evaluate(async () => (await fetch("/documents/study/plot-tip-hold.svg")).status))).toBe(200);
    expect(opened.trouble).toEqual([]);
  });

  it("says that no forceps are attached", async () => {
    trainer = await startTrainer("--datasets", data);
    opened = await openPage(`${trainer.address}#/laboratory`);
    await until(() => opened.page.textContent(".calibrate"), (text) => (text ?? "").includes("No forceps are attached"), "it says so");
    await until(() => opened.page.textContent(".datasets"), (text) => (text ?? "").includes("no measurements yet"), "and that the folder is empty");
  });

  it.skipIf(!existsSync(feederProgram))("leads through the whole calibration of a handle and puts it to use", { timeout: 300_000 }, async () => {
    const link = join(data, "handle"), counts = join(data, "counts.yaml"); // whose pad rests within the amplifier's range
    writeFileSync(counts, readFileSync(join(__dirname, "../../models/forceps/default.yaml"), "utf8").replace("zero: 409 count", "zero: 500 count"));
    const feeder: ChildProcess = spawn(feederProgram, ["curricula/research/tip-hold/demonstration.yaml", "--calibration", counts, "--link", link, "--by-hand", "--rate", "5000", "--hold", "600"], { cwd: join(__dirname, "../.."), stdio: ["pipe", "ignore", "ignore"] });
    try {
      await until(() => existsSync(link), (there) => there, "the handle is there");
      trainer = await startTrainer("--datasets", data, "--serial", link);
      opened = await openPage(`${trainer.address}#/laboratory`);
      const { page } = opened;
      const field = (label: string) => page.locator(`.calibration-form label:has-text("${label}") input`);
      await field("Serial number").fill("SN-17");
      await field("Identity").fill("42");
      await field("Openings").fill("0, 6 12 18 x");
      await page.click("[data-step=go]");
      await until(() => page.textContent(".calibrate .trouble"), (text) => (text ?? "").includes("numbers"), "letters are no openings");
      await field("Openings").fill("0, 6, 12, 18, 24");
      await field("Loads").fill("0, 0.5, 1, 2, 3");
      await page.click("[data-step=go]");
      const taken = (n: number) => until(() => page.textContent(".calibrate"), (text) => (text ?? "").includes(`${n} of 40 values`), `${n} values are taken`);
      const ways = (values: number[]) => [...values, ...values.slice().reverse()];
      const plan: [number, number][] = [];
      for (let k = 0; k < 2; ++k) for (const angle of ways([0, 6, 12, 18, 24])) plan.push([angle, 0]);
      for (let k = 0; k < 2; ++k) for (const force of ways([0, 0.5, 1, 2, 3])) plan.push([3, force]);
      const counts = async () => Number.parseFloat((await page.textContent(".live-count")) ?? "");
      const move = async ([angle, force]: [number, number], moves = true) => { // steps are of 300 counts and more; a busy machine follows late
        const before = await counts();
        feeder.stdin!.write(`${angle} ${force}\n`);
        await until(counts, (now) => !Number.isNaN(now) && (!moves || Number.isNaN(before) || Math.abs(now - before) > 100), "the handle has moved");
        await page.waitForTimeout(60);
      };
      await taken(0);
      for (let k = 0; k < plan.length; ++k) {
        await move(plan[k], k % 5 !== 0); // every fifth is the last one again, from the other side
        await page.waitForFunction(() => /(Set the opening|Load the pad)/.test(document.querySelector(".instruction")?.textContent ?? ""));
        if (k === 3) { // one is read by mistake and taken back, by keyboard
          expect(await page.textContent(".instruction")).toContain("18 deg");
          await page.keyboard.press("Backspace");
          await taken(2);
          await move([12, 0]);
          await page.keyboard.press("Enter");
          await taken(3);
          await move(plan[k]);
        }
        if (k === 0) await page.focus("[data-step=go]");
        await page.keyboard.press("Enter"); // the button keeps the focus from value to value
        if (k < plan.length - 1) {
          const done = () => page.waitForFunction((n) => new RegExp(`\\b${n} of 40 values|The same value again`).exec(document.querySelector(".calibrate")?.textContent ?? "")?.[0], k + 1);
          while (String(await (await done()).jsonValue()).includes("The same")) { // on a machine that stood still: once more
            await page.keyboard.press("Enter");
            await page.waitForTimeout(500);
          }
        }
        if (k === 0) expect(await page.textContent(".live-count")).toContain("counts now");
      }
      await until(() => page.textContent(".instruction"), (text) => (text ?? "").includes("accepted"), "the calibration is accepted");
      expect(await page.textContent(".fits")).toContain("angle [deg]");
      expect(await page.locator(".points circle").count()).toBe(40);
      expect(await page.locator(".points .fit").count()).toBe(2);
      await page.click("[data-step=go]");
      await until(() => page.textContent(".calibrate"), (text) => /In use: .*forceps-\d+-\d+\.yaml/.test(text ?? ""), "it is in use");
      const [file] = readdirSync(join(trainer.folder, "calibrations")), text = readFileSync(join(trainer.folder, "calibrations", file), "utf8");
      for (const line of ['sensor: "SN-17"', "identity: 42", "hysteresis:", "residual:", "upwards: false"]) expect(text).toContain(line);
      expect(opened.trouble).toEqual([]);
    } finally { feeder.kill("SIGTERM"); }
  });

  it.skipIf(!existsSync(boardProgram))("leads through the calibration of a camera, shows what is covered and writes the result", { timeout: 300_000 }, async () => {
    execFileSync(boardProgram, [data]);
    trainer = await startTrainer("--datasets", data, "--camera", join(data, "view_%03d.png"));
    opened = await openPage(`${trainer.address}#/laboratory`);
    const { page } = opened;
    await page.fill(".camera label:has-text('Name') input", "field camera");
    await page.click("[data-camera=start]");
    await page.waitForSelector(".camera .preview");
    await until(() => page.locator(".camera .preview").evaluate((image) => (image as HTMLImageElement).naturalWidth), (width) => width === 480, "the camera's picture is shown");
    await until(() => page.locator(".camera .wishes li").count(), (count) => count === 15, "what is wanted is listed");
    await until(() => page.locator(".camera .wishes .granted").count(), (count) => count === 15, "everything is covered");
    await page.click("[data-camera=calibrate]");
    await until(() => page.textContent(".camera"), (text) => (text ?? "").includes("The camera is calibrated"), "it calibrates");
    expect(await page.textContent(".camera table")).toMatch(/px rms over 1\d views/);
    const [file] = readdirSync(join(trainer.folder, "calibrations")).filter((name) => name.endsWith(".yaml")), text = readFileSync(join(trainer.folder, "calibrations", file), "utf8");
    expect(text).toContain('camera: "field camera"');
    expect(Number(/fx: (.*)/.exec(text)![1])).toBeGreaterThan(655);
    expect(Number(/fx: (.*)/.exec(text)![1])).toBeLessThan(680);
    await page.click("[data-camera=stop]");
    await page.waitForSelector("[data-camera=start]");
    expect(opened.trouble).toEqual([]);
  });

  it("moves the tools by a tracker on the line while the browser shows them", { timeout: 300_000 }, async () => {
    const tracker = createServer((socket) => { // OpenIGTLink: one pose every 10 ms, drawing a circle
      socket.on("error", () => undefined);
      let k = 0;
      const timer = setInterval(() => socket.write(transform("Tool0", [4 * Math.cos(0.05 * k), 4 * Math.sin(0.05 * k++), 6])), 10);
      socket.on("close", () => clearInterval(timer));
    });
    await new Promise<void>((done) => tracker.listen(0, "127.0.0.1", done));
    try {
      trainer = await startTrainer("--datasets", data, "--hands", `igtl:${(tracker.address() as { port: number }).port}`);
      opened = await openPage(trainer.address);
      const { page } = opened;
      await page.click('button[data-task="trace"]');
      await page.check("input[value=device]");
      await page.click("button[type=submit]");
      const tip = () => opened.frame()?.tools[0].pose.position ?? [0, 0, 0];
      await until(opened.frame, (frame) => frame !== undefined && frame.time > 1, "the session runs");
      await until(tip, (p) => p[0] > 2e-3, "the tool goes to the right");
      await until(tip, (p) => p[0] < -2e-3, "and to the left");
      await page.click(".end");
    } finally { tracker.close(); }
  });
});

/// A TRANSFORM message of protocol version 1, unit rotation, position in millimetres; its time is now.
function transform(name: string, [x, y, z]: number[]): Buffer {
  const message = Buffer.alloc(58 + 48);
  message.writeUInt16BE(1, 0);
  message.write("TRANSFORM", 2);
  message.write(name, 14);
  message.writeUInt32BE(Math.floor(Date.now() / 1000), 34);
  message.writeUInt32BE(Math.floor(((Date.now() % 1000) / 1000) * 2 ** 32), 38);
  message.writeUInt32BE(48, 46);
  [1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z].forEach((value, i) => message.writeFloatBE(value, 58 + 4 * i));
  let crc = 0n; // CRC-64, ECMA-182
  for (const byte of message.subarray(58)) {
    crc ^= BigInt(byte) << 56n;
    for (let bit = 0; bit < 8; ++bit) crc = crc & (1n << 63n) ? BigInt.asUintN(64, (crc << 1n) ^ 0x42F0E1EBA9EA3693n) : BigInt.asUintN(64, crc << 1n);
  }
  message.writeBigUInt64BE(crc, 50);
  return message;
}
