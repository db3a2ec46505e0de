// The line to the trainer: one WebSocket that comes back by itself after a loss.
import type { ClientMessage, ServerMessage } from "../messages";

export type LineState = "connecting" | "open" | "lost";

const kFirstWait = 250, kLongestWait = 4000; // [ms]

/// Waiting time before attempt number `attempt` (from 0): doubles up to a limit.
export function waitBefore(attempt: number): number {
  return Math.min(kLongestWait, kFirstWait * Math.pow(2, attempt));
}

export class Connection {
  state: LineState = "connecting";
  onstate: (state: LineState) => void = () => {};
  onmessage: (message: ServerMessage) => void = () => {};
  private socket: WebSocket | null = null;
  private attempts = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private closed = false;

  constructor(private readonly address: string, private readonly open: (address: string) => WebSocket = (a) => new WebSocket(a)) {}

  connect(): void {
    if (this.closed) return;
    const socket = this.open(this.address);
    this.socket = socket;
    socket.onopen = () => { this.attempts = 0; this.become("open"); };
    socket.onmessage = (event: MessageEvent) => {
      let message: ServerMessage;
      try { message = JSON.parse(String(event.data)) as ServerMessage; } catch { return; } // not ours: the next one will do
      this.onmessage(message);
    };
    socket.onclose = () => { if (this.socket === socket) this.lose(); };
  }

  /// False when the line is down; the caller decides whether that matters.
  send(message: ClientMessage): boolean {
    if (this.state !== "open" || !this.socket) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  /// Tries again at once instead of after the waiting time.
  retry(): void {
    if (this.state !== "lost") return;
    clearTimeout(this.timer);
    this.become("connecting");
    this.connect();
  }

  close(): void {
    this.closed = true;
    clearTimeout(this.timer);
    this.socket?.close();
  }

  private lose(): void {
    this.socket = null;
    this.become("lost");
    if (this.closed) return;
    this.timer = setTimeout(() => this.connect(), waitBefore(this.attempts++));
  }

  private become(state: LineState): void {
    if (state === this.state) return;
    this.state = state;
    this.onstate(state);
  }
}
