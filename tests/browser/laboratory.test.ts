// The laboratory's pages with the real trainer: reconcile with progress and cancel, calibration of the forceps, analysis of a session.
import { spawn, type ChildProcess } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { feederProgram, hasTrainer, openPage, startTrainer, until, type Opened, type Trainer } from "./browser";

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
    await until(() => page.textContent(".reconcile [role=status]"), (text) => (text ?? "").includes("cancelled"), "it is cancelled");
    expect(await page.locator("[data-report=long]").count()).toBe(0);
    expect(opened.trouble).toEqual([]);
  });

  it("analyses a recorded session on its result page", { timeout: 600_000 }, async () => {
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
    expect(opened.trouble).toEqual([]);
  });

  it("says that no forceps are attached", async () => {
    trainer = await startTrainer("--datasets", data);
    opened = await openPage(`${trainer.address}#/laboratory`);
    await until(() => opened.page.textContent(".calibrate"), (text) => (text ?? "").includes("No forceps are attached"), "it says so");
    await until(() => opened.page.textContent(".datasets"), (text) => (text ?? "").includes("no measurements yet"), "and that the folder is empty");
  });

  it.skipIf(!existsSync(feederProgram))("leads through the calibration of a handle", { timeout: 300_000 }, async () => {
    const link = join(data, "handle");
    const feeder: ChildProcess = spawn(feederProgram, ["curricula/tip-hold/demonstration.yaml", "--link", link, "--hold", "600"], { cwd: join(__dirname, "../.."), stdio: "ignore" });
    try {
      await until(() => existsSync(link), (there) => there, "the handle is there");
      trainer = await startTrainer("--datasets", data, "--serial", link);
      opened = await openPage(`${trainer.address}#/laboratory`);
      const { page } = opened;
      await page.click("[data-step=go]");
      await until(() => page.textContent(".instruction"), (text) => (text ?? "").includes("0 deg"), "it asks for the first opening");
      await page.keyboard.press("Enter"); // the button keeps the focus from value to value
      await until(() => page.textContent(".calibrate"), (text) => (text ?? "").includes("1 of 48 values"), "one value is taken");
      expect(await page.locator(".points circle").count()).toBe(1);
      await page.keyboard.press("Enter");
      await until(() => page.textContent(".calibrate"), (text) => (text ?? "").includes("2 of 48 values"), "and the next");
      await page.click("[data-step=stop]");
      await until(() => page.textContent(".calibrate"), (text) => (text ?? "").includes("Start calibration"), "it can be left");
      expect(opened.trouble).toEqual([]);
    } finally { feeder.kill("SIGTERM"); }
  });
});
