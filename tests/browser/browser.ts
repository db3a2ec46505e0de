// Starts Chromium and the real trainer for the browser tests.
import { spawn, type ChildProcess } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { connect, createServer, type Socket } from "node:net";
import { chromium, type BrowserContext, type Page } from "playwright-core";
import type { Frame } from "@viewer/messages";

const kRepository = fileURLToPath(new URL("../..", import.meta.url));
const kFlags = ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

type Message = { type: string } & Record<string, unknown>;
export interface Opened {
  page: Page;
  trouble: string[]; // errors that a user could only find in the console
  received: Message[]; // what came over the WebSocket; of the frames only the newest
  frame(): Frame | undefined;
  close(): Promise<void>;
}

/// A page in a browser of its own with a fresh profile.
export async function openPage(address: string): Promise<Opened> {
  const profile = mkdtempSync(join(tmpdir(), "filum-chromium-"));
  const context: BrowserContext = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.FILUM_CHROMIUM ?? "/usr/bin/chromium", headless: true, args: kFlags, viewport: { width: 1280, height: 760 },
  });
  const page = context.pages()[0] ?? (await context.newPage());
  page.setDefaultTimeout(120_000);
  const trouble: string[] = [];
  page.on("pageerror", (error) => trouble.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error" && !/WebSocket connection|ERR_CONNECTION/.test(message.text())) trouble.push(message.text());
  });
  const received: Message[] = [];
  let frame: Frame | undefined;
  page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => {
    const message = JSON.parse(String(payload)) as Message;
    if (message.type === "frame") frame = message as unknown as Frame;
    else received.push(message);
  }));
  await page.goto(address);
  return { page, trouble, received, frame: () => frame, close: async () => { await context.close(); rmSync(profile, { recursive: true, force: true }); } };
}

export const trainerProgram = process.env.FILUM_BIN ?? "";
/// A handle for whoever has none, built beside the program; plays a demonstration on a pseudo terminal.
export const feederProgram = trainerProgram ? join(dirname(resolve(kRepository, trainerProgram)), "tests", "filum_serial_feeder") : "";
/// Pictures of a chessboard for whoever has no camera; there where OpenCV is.
export const boardProgram = trainerProgram ? join(dirname(resolve(kRepository, trainerProgram)), "tests", "filum_board_pictures") : "";
export const hasTrainer = trainerProgram !== "" && existsSync(resolve(kRepository, trainerProgram));

export interface Trainer { address: string; folder: string; stop(): Promise<void> }

/// Starts the real program on a free port with a store of its own and waits for the address it prints.
export async function startTrainer(...more: string[]): Promise<Trainer> {
  const folder = mkdtempSync(join(tmpdir(), "filum-store-"));
  const child: ChildProcess = spawn(resolve(kRepository, trainerProgram), ["train", "--port", "0", "--store", folder, ...more], { stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  const address = await new Promise<string>((done, fail) => {
    const listen = (data: Buffer) => {
      said += String(data);
      const found = /http:\/\/127\.0\.0\.1:\d+\//.exec(said);
      if (found) done(found[0]);
    };
    child.stdout!.on("data", listen);
    child.stderr!.on("data", listen);
    child.on("exit", (code) => fail(new Error(`the trainer ended with ${code} before it printed its address:\n${said}`)));
  });
  const stop = () => new Promise<void>((done) => {
    const finish = () => { rmSync(folder, { recursive: true, force: true }); done(); };
    if (child.exitCode !== null) { finish(); return; }
    child.removeAllListeners("exit");
    child.on("exit", finish);
    child.kill("SIGTERM");
  });
  return { address, folder, stop };
}

/// A line between browser and trainer that can be cut: all connections at once, as when a cable is pulled.
export async function cuttableLine(address: string): Promise<{ address: string; cut(): void; close(): Promise<void> }> {
  const open = new Set<Socket>(), port = Number(new URL(address).port);
  const server = createServer((near) => {
    const far = connect(port, "127.0.0.1");
    for (const [one, other] of [[near, far], [far, near]]) {
      open.add(one);
      one.pipe(other);
      one.on("error", () => other.destroy());
      one.on("close", () => { open.delete(one); other.destroy(); });
    }
  });
  await new Promise<void>((done) => server.listen(0, "127.0.0.1", done));
  const cut = () => { for (const socket of open) socket.destroy(); };
  const at = server.address() as { port: number };
  return { address: `http://127.0.0.1:${at.port}/`, cut, close: () => { cut(); return new Promise((done) => server.close(() => done())); } };
}

/// Waits until `read` gives something that `good` accepts, and returns it.
export async function until<T>(read: () => Promise<T> | T, good: (value: T) => boolean, what: string, seconds = 120): Promise<T> {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const value = await read();
    if (good(value)) return value;
    if (Date.now() > end) throw new Error(`${what}: still ${JSON.stringify(value)} after ${seconds} s`);
    await new Promise((done) => setTimeout(done, 100));
  }
}

/// How many distinct colours the field shows: an empty one has few.
export async function fieldColours(page: Page): Promise<number> {
  const png = await page.locator(".surface").screenshot({ timeout: 120_000 });
  return page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height), g = canvas.getContext("2d")!;
    g.drawImage(image, 0, 0);
    const { data } = g.getImageData(0, 0, image.width, image.height);
    const seen = new Set<number>();
    for (let i = 0; i < data.length; i += 4 * 7) seen.add(((data[i] >> 3) << 10) | ((data[i + 1] >> 3) << 5) | (data[i + 2] >> 3));
    return seen.size;
  }, png.toString("base64"));
}
