// The operator's hands as a device: poses and grips integrated from mouse, keyboard and gamepad. These are device poses; what
// the instruments then do is the trainer's business. Metres, world frame W (x right, y away, z up).
import type { Pointer, Quaternion, ToolState, Vec3 } from "../messages";

export type Axis = 0 | 1 | 2;

export interface Hand {
  position: Vec3; // [m]
  quaternion: Quaternion; // w x y z
  grip: number; // 0 open ... 1 closed tight
  closing: boolean; // a key or button holds the grip closing
  latched: boolean; // the grip stays when nothing holds it
  buttons: number; // 1 clutch, 2 cut, 4 next, 8 and 16 clamps off, 32 fresh suture
  tapped: number; // those pressed a moment ago: a tap between two messages counts, also with a trainer that is late
  since: number; // [s], when a message first told of them
}

export const kClutch = 1, kCut = 2, kNext = 4, kUpstreamOff = 8, kDownstreamOff = 16, kFresh = 32;
const kClosedGrip = 0.6, kHardestTurn = 0.25; // as the trainer reads a grip: the jaws meet there; [rad], by which 1 turns them on
const kSqueezeStiffness = 12; // [N/rad], of jaws that something stops
const kTap = 0.06; // [s], for which a tap is told
const kCloseRate = 2.2, kOpenRate = 4.5; // [1/s]
const kReach = 0.06; // [m], hands stay within this distance of the middle of the scene
const kLowest = 0.17; // smallest upward part of the tool axis: the handle stays above the tip

export function multiply(a: Quaternion, b: Quaternion): Quaternion {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}

export function about(axis: Vec3, angle: number): Quaternion {
  const s = Math.sin(angle / 2), length = Math.hypot(...axis) || 1;
  return [Math.cos(angle / 2), (s * axis[0]) / length, (s * axis[1]) / length, (s * axis[2]) / length];
}

/// Upward part of the tool's own z axis (towards the handle).
export function uprightness(q: Quaternion): number {
  return 1 - 2 * (q[1] * q[1] + q[2] * q[2]);
}

function unit(q: Quaternion): Quaternion {
  const length = Math.hypot(...q) || 1;
  return [q[0] / length, q[1] / length, q[2] / length, q[3] / length];
}

/// The grip that keeps opening and squeeze as they are: jaws that squeeze are told to close further than what they hold lets them.
function gripOf(tool: ToolState, widest: number): number {
  const told = tool.grip_angle - tool.grip_force / kSqueezeStiffness; // [rad]
  const grip = told < 0 ? kClosedGrip - (1 - kClosedGrip) * told / kHardestTurn : widest > 0 ? kClosedGrip * (1 - told / widest) : 0;
  return Math.min(1, Math.max(0, grip));
}

export class Hands {
  readonly hands: Hand[] = [];
  active = 0;
  private centre: Vec3 = [0, 0, 0];
  private spare: boolean[] = [];
  private before = 0; // the hand that was active before a spare tool was taken up

  /// Takes over where the instruments are, so that nothing jumps when the pointer becomes the device.
  /// `spare`: tools that lie ready beside the two hands, such as scissors.
  adopt(tools: readonly ToolState[], openings: readonly number[], spare: readonly boolean[] = []): void {
    this.hands.length = 0;
    this.spare = tools.map((_, i) => spare[i] ?? false);
    tools.forEach((tool, i) => {
      const grip = gripOf(tool, openings[i]);
      this.hands.push({
        position: [...tool.device_pose.position], quaternion: [...tool.device_pose.quaternion], grip,
        closing: false, latched: grip > kClosedGrip / 2, buttons: 0, tapped: 0, since: -1,
      });
    });
    this.centre = [0, 1, 2].map((k) => this.hands.reduce((sum, hand) => sum + hand.position[k], 0) / Math.max(1, this.hands.length)) as Vec3;
    this.active = Math.max(0, this.spare.lastIndexOf(false));
    this.before = this.active;
  }

  get ready(): boolean { return this.hands.length > 0; }

  /// The next hand becomes the active one; the hand that is left keeps its pose and its grip.
  switchHand(): void {
    const main = this.hands.map((_, i) => i).filter((i) => !this.spare[i]);
    if (main.length > 0) this.activate(main[(main.indexOf(this.spare[this.active] ? this.before : this.active) + 1) % main.length]);
  }

  /// Takes up the spare tool, or goes back to the hand that was active before.
  switchSpare(): void {
    if (this.spare[this.active]) { this.activate(this.before); return; }
    const spare = this.spare.indexOf(true);
    if (spare < 0) return;
    this.before = this.active;
    this.activate(spare);
  }

  private activate(index: number): void {
    const left = this.hands[this.active];
    if (left) { left.latched = left.grip > 0.05; left.closing = false; left.buttons = 0; } // what is let go from now on is the other hand's
    this.active = index;
  }

  move(index: number, dx: number, dy: number, dz: number): void {
    const hand = this.hands[index];
    if (!hand || (hand.buttons & kClutch) !== 0) return;
    [dx, dy, dz].forEach((step, k) => {
      const wanted = hand.position[k] + step;
      hand.position[k] = Math.min(this.centre[k] + kReach, Math.max(this.centre[k] - kReach, wanted));
    });
  }

  /// Turns the handle about its own axis; the tip stays.
  roll(index: number, angle: number): void {
    const hand = this.hands[index];
    if (hand) hand.quaternion = unit(multiply(hand.quaternion, about([0, 0, 1], angle)));
  }

  /// Swings the handle about the tip: `yaw` about the vertical, `pitch` about the line across the field.
  tilt(index: number, yaw: number, pitch: number): void {
    const hand = this.hands[index];
    if (!hand) return;
    hand.quaternion = unit(multiply(about([0, 0, 1], yaw), hand.quaternion));
    const next = unit(multiply(about([1, 0, 0], pitch), hand.quaternion));
    if (uprightness(next) > kLowest || uprightness(next) > uprightness(hand.quaternion)) hand.quaternion = next;
  }

  /// A key or button starts or ends closing. A press ends a latch, so that press and release opens again.
  hold(index: number, closing: boolean): void {
    const hand = this.hands[index];
    if (!hand) return;
    if (closing && !hand.closing) hand.latched = false;
    hand.closing = closing;
  }

  /// Keeps the grip as it is, or lets it go.
  toggleLatch(index: number): void {
    const hand = this.hands[index];
    if (hand) hand.latched = !hand.latched;
  }

  /// Fine control of the squeeze; keeps what it has set.
  squeeze(index: number, change: number): void {
    const hand = this.hands[index];
    if (!hand) return;
    hand.grip = Math.min(1, Math.max(0, hand.grip + change));
    hand.latched = true;
  }

  /// A trigger that reports how far it is pulled.
  setGrip(index: number, grip: number): void {
    const hand = this.hands[index];
    if (hand) { hand.grip = Math.min(1, Math.max(0, grip)); hand.latched = true; }
  }

  press(index: number, button: number, down: boolean): void {
    const hand = this.hands[index];
    if (!hand) return;
    hand.buttons = down ? hand.buttons | button : hand.buttons & ~button;
    if (down) hand.tapped |= button;
  }

  releaseAll(): void {
    for (const hand of this.hands) { hand.closing = false; hand.buttons = hand.tapped = 0; hand.since = -1; }
  }

  /// Lets time pass for the grips [s].
  advance(seconds: number): void {
    for (const hand of this.hands) {
      if (hand.closing) { if (!hand.latched) hand.grip = Math.min(1, hand.grip + kCloseRate * seconds); }
      else if (!hand.latched) hand.grip = Math.max(0, hand.grip - kOpenRate * seconds);
    }
  }

  message(index: number, time: number): Pointer {
    const hand = this.hands[index], buttons = hand.buttons | hand.tapped;
    if (hand.tapped !== 0 && hand.since < 0) hand.since = time;
    if (hand.tapped !== 0 && time - hand.since >= kTap) { hand.tapped = 0; hand.since = -1; }
    return {
      type: "pointer", tool: index, time, position: [...hand.position], quaternion: [...hand.quaternion], grip: hand.grip,
      buttons,
    };
  }
}
