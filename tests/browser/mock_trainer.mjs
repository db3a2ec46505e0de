// A make-believe trainer for tests of the viewer alone: it speaks the message protocol with made-up frames, so that states
// that are rare in real life (a warning of each level, a lost line) can be shown at will. The tests of the whole program use
// the real one. Starts on a free port: `node mock_trainer.mjs [port]` prints its address.
import { createServer } from "node:http";
import { createReadStream, existsSync } from "node:fs";
import { createRequire } from "node:module";
import { extname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { frameAt, kScene, kTasks, resultOf } from "../viewer/sample_frames.mjs";

const viewer = fileURLToPath(new URL("../../src/viewer/", import.meta.url));
const { WebSocketServer } = createRequire(join(viewer, "package.json"))("ws");
const kTypes = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css" };

/// `duration` [s] of the make-believe task.
export function startMock({ port = 0, duration = 8 } = {}) {
  const state = { running: false, ended: false, input: null, time: 0, replay: null, playing: false, pointers: [], acks: 0, hold: false, sockets: new Set(), starts: [] };
  const kInfo = { id: "s1", task: "knot-square", title: "Square knot", input: "demo", code: "A17", started: "2026-11-21T08:30:00Z", seconds: duration, finished: true, passed: true, total: 89 };
  const http = createServer((request, response) => {
    const path = new URL(request.url, "http://x").pathname;
    const json = (body) => { response.setHeader("content-type", "application/json"); response.end(JSON.stringify(body)); };
    if (path === "/api/tasks") return json({ tasks: kTasks });
    if (path === "/api/sessions") return json({ sessions: [kInfo, { ...kInfo, id: "s2", finished: false, passed: null, total: null, input: "pointer", code: "" }] });
    if (path === "/api/sessions/s1") return json({ session: kInfo, result: resultOf("s1", duration) });
    const file = join(viewer, "dist", path === "/" ? "index.html" : path);
    if (!existsSync(file)) { response.statusCode = 404; return response.end(); }
    response.setHeader("content-type", kTypes[extname(file)] ?? "application/octet-stream");
    createReadStream(file).pipe(response);
    return undefined;
  });
  const ws = new WebSocketServer({ server: http, path: "/ws" });
  let clients = 0;
  ws.on("connection", (socket) => {
    const me = { socket, credit: 2, id: 0, number: ++clients };
    state.sockets.add(me);
    const say = (message) => socket.send(JSON.stringify(message));
    say({ type: "hello", program: "filum", version: "mock", protocol: 1, client: me.number, tasks: kTasks, devices: [], inputs: ["pointer", "demo"] });
    say(sessionState(state));
    if (state.running) say(kScene);
    socket.on("close", () => state.sockets.delete(me));
    socket.on("message", (data) => {
      const message = JSON.parse(String(data));
      if (message.type === "ack") { ++me.credit; ++state.acks; }
      else if (message.type === "pointer") state.pointers.push(message);
      else if (message.type === "start") { state.starts.push(message); Object.assign(state, { running: true, ended: false, input: message.input, time: 0, replay: null }); all(sessionState(state)); all(kScene); }
      else if (message.type === "stop") { if (state.replay) state.replay = null; else finish(false); all(sessionState(state)); }
      else if (message.type === "replay_open") { Object.assign(state, { replay: message.session, running: false, ended: false, time: 0, playing: false }); all(sessionState(state)); say(kScene); say(resultOf(message.session, duration)); sayReplay(); force = true; }
      else if (message.type === "seek") { state.time = message.time; sayReplay(); force = true; }
      else if (message.type === "play" || message.type === "pause") { state.playing = message.type === "play"; sayReplay(); }
    });
  });
  let force = false;
  const all = (message) => { for (const { socket } of state.sockets) socket.send(JSON.stringify(message)); };
  const sayReplay = () => all({ type: "replay_state", session: state.replay, time: state.time, duration, ready: duration, playing: state.playing });
  const finish = (finished) => { Object.assign(state, { running: false, ended: true }); all({ ...resultOf("s1", duration), finished }); all(sessionState(state)); };
  const timer = setInterval(() => {
    const moving = state.running || (state.replay && state.playing);
    if (moving) state.time += 1 / 60;
    if ((!moving || state.hold) && !force) return;
    force = false;
    for (const me of state.sockets) {
      if (me.credit <= 0) continue;
      --me.credit;
      me.socket.send(JSON.stringify(frameAt(state.time, ++me.id, duration)));
    }
    if (state.replay && state.playing) { if (state.time >= duration) state.playing = false; sayReplay(); }
    if (state.running && state.time >= duration) finish(true);
  }, 1000 / 60);
  return new Promise((resolve) => http.listen(port, "127.0.0.1", () => resolve({
    address: `http://127.0.0.1:${http.address().port}/`, state,
    nextScene: () => { for (const me of state.sockets) { for (; me.credit > 0; --me.credit) me.socket.send(JSON.stringify(frameAt(state.time, ++me.id, duration))); me.socket.send(JSON.stringify(kScene)); } },
    dropSockets: () => { for (const { socket } of state.sockets) socket.terminate(); },
    close: () => { clearInterval(timer); for (const { socket } of state.sockets) socket.terminate(); return new Promise((done) => http.close(done)); },
  })));
}

function sessionState(state) {
  const running = state.running ? "running" : state.replay ? "replay" : state.ended ? "ended" : "idle";
  return { type: "session_state", state: running, task: state.running ? "knot-square" : "", input: state.running ? state.input : null, pointer: Boolean(state.running) && state.input === "pointer", controller: 1, in_control: true, clients: state.sockets.size,
    recording: state.running, exam: false, session: state.running || state.ended ? "s1" : state.replay, warning: "", knot_test: null };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const mock = await startMock({ port: Number(process.argv[2] ?? 0), duration: Number(process.argv[3] ?? 60) });
  console.log(mock.address);
}
