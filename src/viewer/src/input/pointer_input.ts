// Turns mouse, keyboard and gamepad on the field into movements of the hands and sends their poses to the trainer.
import type { Pointer } from "../messages";
import { Hands, kClutch, kCut, kDownstreamOff, kFresh, kNext, kUpstreamOff } from "./hands";

const kSendEvery = 1000 / 120; // [ms]
const kKeepAlive = 40; // [ms], also an unmoved hand is reported: silence would count as a lost device
const kSpeed = 0.3; // fields per second of a movement key
const kTurn = 1.2; // [rad/s]

interface Field {
  metresPerPixel(): number;
  fieldMetres(): number;
  tiltCosine(): number;
}

type Movement = [hand: "left" | "right" | "active", kind: "x" | "y" | "z" | "roll" | "yaw" | "pitch", sign: number];

/// By KeyboardEvent.code, so that the keys lie the same on every keyboard layout.
const kMovements: Record<string, Movement> = {
  KeyA: ["left", "x", -1], KeyD: ["left", "x", 1], KeyW: ["left", "y", 1], KeyS: ["left", "y", -1], KeyR: ["left", "z", 1], KeyF: ["left", "z", -1],
  ArrowLeft: ["right", "x", -1], ArrowRight: ["right", "x", 1], ArrowUp: ["right", "y", 1], ArrowDown: ["right", "y", -1],
  PageUp: ["right", "z", 1], PageDown: ["right", "z", -1],
  KeyQ: ["active", "roll", 1], KeyE: ["active", "roll", -1],
  KeyJ: ["active", "yaw", 1], KeyL: ["active", "yaw", -1], KeyI: ["active", "pitch", -1], KeyY: ["active", "pitch", 1],
};

export class PointerInput {
  readonly hands = new Hands();
  enabled = false;
  onswitch: () => void = () => {};
  private readonly pressed = new Set<string>();
  private readonly cleanup = new AbortController();
  private readonly last: Pointer[] = [];
  private readonly lastSent: number[] = [];
  private shift = false;
  private entered = false; // the mouse has just come in: the way it came from outside is no movement of the hand
  private padButtons = 0; // what the gamepad held last
  private previous = performance.now();
  private timer: ReturnType<typeof setInterval> | undefined;

  constructor(private readonly surface: HTMLElement, private readonly field: Field, private readonly send: (message: Pointer) => boolean) {
    const options = { signal: this.cleanup.signal };
    surface.addEventListener("pointerenter", () => { this.entered = true; }, options);
    surface.addEventListener("pointermove", (event) => this.moved(event), options);
    surface.addEventListener("pointerdown", (event) => this.button(event, true), options);
    surface.addEventListener("pointerup", (event) => this.button(event, false), options);
    surface.addEventListener("pointercancel", () => this.letGo(), options);
    surface.addEventListener("contextmenu", (event) => { if (this.live) event.preventDefault(); }, options);
    surface.addEventListener("wheel", (event) => this.wheel(event), { ...options, passive: false });
    surface.addEventListener("keydown", (event) => this.key(event, true), options);
    surface.addEventListener("keyup", (event) => this.key(event, false), options);
    surface.addEventListener("blur", () => this.letGo(), options);
    window.addEventListener("blur", () => this.letGo(), options);
    this.timer = setInterval(() => this.tick(performance.now()), kSendEvery);
  }

  dispose(): void {
    clearInterval(this.timer);
    this.cleanup.abort();
  }

  get live(): boolean { return this.enabled && this.hands.ready; }

  /// One round of the device: moves by the keys held since the last round, then reports.
  tick(now: number): void {
    const seconds = Math.min(0.1, Math.max(0, (now - this.previous) / 1000));
    this.previous = now;
    if (!this.live) return;
    this.moveByKeys(seconds);
    this.moveByGamepad(seconds);
    this.hands.advance(seconds);
    for (let i = 0; i < this.hands.hands.length; ++i) this.report(i, now);
  }

  private report(index: number, now: number): void {
    const message = this.hands.message(index, now / 1000), before = this.last[index];
    const same = before !== undefined && before.grip === message.grip && before.buttons === message.buttons &&
      before.position.every((v, k) => v === message.position[k]) && before.quaternion.every((v, k) => v === message.quaternion[k]);
    if (same && now - this.lastSent[index] < kKeepAlive) return;
    if (!this.send(message)) return;
    this.last[index] = message;
    this.lastSent[index] = now;
  }

  private moved(event: PointerEvent): void {
    if (!this.live || event.pointerType === "touch") return;
    if (this.entered) { this.entered = false; return; }
    const { active } = this.hands;
    const dx = event.movementX, dy = event.movementY;
    if ((event.buttons & 2) !== 0) this.hands.roll(active, -0.01 * dx);
    else if (event.shiftKey) this.hands.tilt(active, -0.006 * dx, 0.006 * dy);
    else {
      const scale = this.field.metresPerPixel();
      this.hands.move(active, dx * scale, (-dy * scale) / this.field.tiltCosine(), 0);
    }
  }

  private button(event: PointerEvent, down: boolean): void {
    if (!this.live) return;
    if (down) {
      this.surface.focus({ preventScroll: true });
      if (event.pointerId >= 0) { try { this.surface.setPointerCapture(event.pointerId); } catch { /* the pointer has gone */ } }
    }
    if (event.button === 0) this.hands.hold(this.hands.active, down);
  }

  private wheel(event: WheelEvent): void {
    if (!this.live || event.ctrlKey || event.altKey) return;
    event.preventDefault();
    const notches = event.deltaY / 100;
    const hand = this.hands.hands[this.hands.active];
    if (hand.closing) this.hands.squeeze(this.hands.active, -0.05 * notches);
    else this.hands.move(this.hands.active, 0, 0, -notches * 0.01 * this.field.fieldMetres());
  }

  private key(event: KeyboardEvent, down: boolean): void {
    const browsers = event.altKey || event.metaKey || (event.ctrlKey && !event.code.startsWith("Control")); // its own shortcuts
    if (!this.live || (down && browsers)) return;
    const { hands } = this;
    this.shift = event.shiftKey;
    const first = down && !event.repeat;
    switch (event.code) {
      case "Space": hands.hold(hands.active, down); break;
      case "KeyV": hands.hold(0, down); break;
      case "KeyB": hands.hold(1, down); break;
      case "KeyK": if (first) hands.toggleLatch(hands.active); break;
      case "KeyC": hands.press(hands.active, kCut, down); break;
      case "KeyU": hands.press(hands.active, kUpstreamOff, down); break;
      case "KeyZ": hands.press(hands.active, kDownstreamOff, down); break;
      case "KeyT": hands.press(hands.active, kFresh, down); break;
      case "KeyN": hands.press(hands.active, kNext, down); break;
      case "ControlLeft": case "ControlRight": hands.press(hands.active, kClutch, down); break;
      case "KeyP": if (first) void this.surface.requestPointerLock(); break;
      case "Tab":
        if (!first) break;
        hands.switchHand();
        this.onswitch();
        break;
      case "KeyX":
        if (!first) break;
        hands.switchSpare();
        this.onswitch();
        break;
      default:
        if (!(event.code in kMovements)) return;
        if (down) this.pressed.add(event.code);
        else this.pressed.delete(event.code);
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private moveByKeys(seconds: number): void {
    const slow = this.shift ? 0.2 : 1;
    const step = kSpeed * this.field.fieldMetres() * seconds * slow, turn = kTurn * seconds * slow;
    for (const code of this.pressed) {
      const [who, kind, sign] = kMovements[code];
      const hand = who === "left" ? 0 : who === "right" ? 1 : this.hands.active;
      if (kind === "x") this.hands.move(hand, sign * step, 0, 0);
      else if (kind === "y") this.hands.move(hand, 0, sign * step, 0);
      else if (kind === "z") this.hands.move(hand, 0, 0, sign * step);
      else if (kind === "roll") this.hands.roll(hand, sign * turn);
      else this.hands.tilt(hand, kind === "yaw" ? sign * turn : 0, kind === "pitch" ? sign * turn : 0);
    }
  }

  private moveByGamepad(seconds: number): void {
    const pad = navigator.getGamepads?.().find((one) => one !== null && one.connected);
    if (!pad) return;
    const step = kSpeed * this.field.fieldMetres() * seconds;
    const dead = (value: number) => (Math.abs(value) < 0.12 ? 0 : value * Math.abs(value));
    for (let hand = 0; hand < 2; ++hand) {
      const x = dead(pad.axes[2 * hand] ?? 0), y = -dead(pad.axes[2 * hand + 1] ?? 0);
      const deep = pad.buttons[4 + hand]?.pressed ?? false; // bumper held: the stick moves in depth and rolls
      if (deep) { this.hands.move(hand, 0, 0, y * step); this.hands.roll(hand, -x * kTurn * seconds); }
      else if (x !== 0 || y !== 0) this.hands.move(hand, x * step, y * step, 0);
      const trigger = pad.buttons[6 + hand]?.value ?? 0;
      const bit = 1 << (8 + hand);
      if (trigger > 0.02 || (this.padButtons & bit) !== 0) this.hands.setGrip(hand, trigger);
      this.padButtons = trigger > 0.02 ? this.padButtons | bit : this.padButtons & ~bit;
    }
    for (const [number, button] of [[2, kCut], [0, kNext]] as const) {
      const down = pad.buttons[number]?.pressed ?? false, was = (this.padButtons & button) !== 0;
      if (down !== was) {
        this.hands.press(this.hands.active, button, down);
        this.padButtons = down ? this.padButtons | button : this.padButtons & ~button;
      }
    }
  }

  private letGo(): void {
    this.pressed.clear();
    this.hands.releaseAll();
  }
}
