import { vi } from "vitest";
import { Connection, waitBefore } from "@viewer/net/connection";

class FakeSocket {
  onopen: (() => void) | null = null;
  onclose: (() => void) | null = null;
  onmessage: ((event: { data: string }) => void) | null = null;
  sent: string[] = [];
  send(text: string): void { this.sent.push(text); }
  close(): void { this.onclose?.(); }
}

describe("connection", () => {
  const sockets: FakeSocket[] = [];
  const make = () => new Connection("ws://x/ws", () => { const socket = new FakeSocket(); sockets.push(socket); return socket as unknown as WebSocket; });
  beforeEach(() => { sockets.length = 0; vi.useFakeTimers(); });
  afterEach(() => vi.useRealTimers());

  it("comes back after a loss, waiting longer each time, and starts short again after success", () => {
    const line = make(), states: string[] = [];
    line.onstate = (state) => states.push(state);
    line.connect();
    sockets[0].onopen!();
    for (let loss = 0; loss < 3; ++loss) {
      sockets[loss].onclose!();
      vi.advanceTimersByTime(waitBefore(loss) - 1);
      expect(sockets.length).toBe(loss + 1);
      vi.advanceTimersByTime(1);
      expect(sockets.length).toBe(loss + 2);
    }
    sockets[3].onopen!();
    sockets[3].onclose!();
    vi.advanceTimersByTime(waitBefore(0));
    expect(sockets.length).toBe(5);
    expect(states).toEqual(["open", "lost", "open", "lost"]);
  });

  it("never waits longer than a few seconds", () => {
    expect(waitBefore(30)).toBeLessThanOrEqual(5000);
  });

  it("says when a message could not be sent", () => {
    const line = make();
    line.connect();
    expect(line.send({ type: "stop" })).toBe(false);
    sockets[0].onopen!();
    expect(line.send({ type: "stop" })).toBe(true);
    expect(JSON.parse(sockets[0].sent[0])).toEqual({ type: "stop" });
  });

  it("passes messages on and survives one that is not JSON", () => {
    const line = make(), got: string[] = [];
    line.onmessage = (message) => got.push(message.type);
    line.connect();
    sockets[0].onmessage!({ data: "{not json" });
    sockets[0].onmessage!({ data: JSON.stringify({ type: "hello" }) });
    expect(got).toEqual(["hello"]);
  });

  it("stays closed once closed", () => {
    const line = make();
    line.connect();
    line.close();
    vi.advanceTimersByTime(60000);
    expect(sockets.length).toBe(1);
  });
});
