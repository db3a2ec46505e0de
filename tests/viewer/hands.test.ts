import { Hands, kClutch, kCut, multiply, uprightness } from "@viewer/input/hands";
import type { Quaternion, ToolState, Vec3 } from "@viewer/messages";

const tool = (x: number, angle: number, squeeze = 0): ToolState => {
  const pose = { position: [x, 0, 0.005] as Vec3, quaternion: [1, 0, 0, 0] as Quaternion };
  return { pose, device_pose: pose, grip_angle: angle, grip_force: squeeze, thread_force: 0, force: [0, 0, 0], grasped: -1, input_valid: true };
};

function adopted(): Hands {
  const hands = new Hands();
  hands.adopt([tool(-0.003, 0.5), tool(0.003, 0.02)], [0.5, 0.5]);
  return hands;
}

describe("hands", () => {
  it("begin where the instruments are", () => {
    const hands = adopted();
    expect(hands.message(0, 1).position).toEqual([-0.003, 0, 0.005]);
    expect(hands.message(0, 1).grip).toBeCloseTo(0);
    expect(hands.message(1, 1).grip).toBeCloseTo(0.576);
  });

  it("keep jaws as wide and squeezing as hard as they are", () => {
    const told = (grip: number, widest: number): number => grip < 0.6 ? widest * (1 - grip / 0.6) : -0.25 * (grip - 0.6) / 0.4; // the trainer's grip_angle_of
    for (const [angle, squeeze] of [[0.5, 0], [0.35, 0], [0.02, 0], [0, 0], [0, 1], [0, 3], [0.1, 0.5], [0.02, 0.6]]) {
      const hands = new Hands();
      hands.adopt([tool(0, angle, squeeze)], [0.5]);
      hands.advance(0);
      const command = told(hands.message(0, 1).grip, 0.5);
      expect(command).toBeCloseTo(angle - squeeze / 12); // 3 N at 0.25 rad
    }
  });

  it("a button that is held while the hand is changed is let go", () => {
    const hands = new Hands();
    hands.adopt([tool(-0.003, 0.1), tool(0.003, 0.1)], [0.5, 0.5]);
    hands.message(1, 0);
    hands.press(1, kCut, true);
    hands.message(1, 0.1);
    hands.message(1, 0.2);
    hands.switchHand();
    hands.press(hands.active, kCut, false);
    expect(hands.message(1, 0.3).buttons).toBe(0);
    expect(hands.message(0, 0.3).buttons).toBe(0);
  });

  it("only the moved hand moves, the other keeps pose and grip", () => {
    const hands = adopted();
    hands.active = 1;
    hands.hold(1, true);
    hands.advance(1);
    hands.switchHand();
    const before = hands.message(1, 0);
    hands.move(hands.active, 0.001, -0.002, 0.003);
    hands.roll(hands.active, 0.4);
    hands.advance(5);
    expect(hands.active).toBe(0);
    expect(hands.message(1, 0)).toEqual(before);
    hands.message(0, 0).position.forEach((v, k) => expect(v).toBeCloseTo([-0.002, -0.002, 0.008][k]));
  });

  it("change between the two hands, and take up the spare tool and put it down again", () => {
    const hands = new Hands();
    hands.adopt([tool(-0.003, 0.1), tool(0.003, 0.1), tool(0.01, 0.1)], [0.5, 0.5, 0.5], [false, false, true]);
    const active = [hands.active];
    for (const change of ["hand", "hand", "spare", "spare", "spare", "hand", "hand"]) {
      if (change === "hand") hands.switchHand();
      else hands.switchSpare();
      active.push(hands.active);
    }
    expect(active).toEqual([1, 0, 1, 2, 1, 2, 0, 1]);
  });

  it("closes while held, opens when let go, and stays when latched", () => {
    const hands = adopted();
    hands.hold(0, true);
    hands.advance(0.1);
    const soft = hands.message(0, 0).grip;
    expect(soft).toBeGreaterThan(0.1);
    expect(soft).toBeLessThan(0.5);
    hands.advance(2);
    expect(hands.message(0, 0).grip).toBe(1);
    hands.toggleLatch(0);
    hands.hold(0, false);
    hands.advance(2);
    expect(hands.message(0, 0).grip).toBe(1);
    hands.hold(0, true);
    hands.hold(0, false);
    hands.advance(2);
    expect(hands.message(0, 0).grip).toBe(0);
  });

  it("keeps the tip in place while the handle turns, and the handle above the tip", () => {
    const hands = adopted();
    for (let i = 0; i < 200; ++i) hands.tilt(0, 0.05, 0.1);
    const { position, quaternion } = hands.message(0, 0);
    expect(position).toEqual([-0.003, 0, 0.005]);
    expect(uprightness(quaternion)).toBeGreaterThan(0.1);
    expect(Math.hypot(...quaternion)).toBeCloseTo(1);
    hands.roll(0, 1);
    expect(uprightness(hands.message(0, 0).quaternion)).toBeCloseTo(uprightness(quaternion));
  });

  it("does not move while the clutch is held", () => {
    const hands = adopted();
    hands.press(0, kClutch, true);
    hands.press(0, kCut, true);
    hands.move(0, 0.01, 0, 0);
    expect(hands.message(0, 0).position[0]).toBe(-0.003);
    expect(hands.message(0, 0).buttons).toBe(kClutch | kCut);
    hands.press(0, kClutch, false);
    hands.move(0, 0.001, 0, 0);
    expect(hands.message(0, 0).position[0]).toBeCloseTo(-0.002);
  });

  it("stays within reach and within the limits of the message", () => {
    const hands = adopted();
    for (let i = 0; i < 1000; ++i) { hands.move(0, 0.01, 0, -0.01); hands.squeeze(0, 0.3); }
    const message = hands.message(0, 0);
    expect(message.position[0]).toBeLessThan(0.07);
    expect(message.position[2]).toBeGreaterThan(-0.07);
    expect(message.grip).toBe(1);
  });

  it("multiplies quaternions as rotations", () => {
    const s = Math.SQRT1_2;
    const both = multiply([s, 0, 0, s], [s, s, 0, 0]); // first about x, then about z, a quarter each
    expect(both).toEqual([0.5, 0.5, 0.5, 0.5].map((v) => expect.closeTo(v)));
  });
  it("reports a key that was tapped between two messages for a moment", () => {
    const hands = adopted();
    hands.press(0, kCut, true);
    hands.press(0, kCut, false);
    expect(hands.message(0, 0).buttons).toBe(kCut);
    expect(hands.message(0, 0.04).buttons).toBe(kCut);
    hands.message(0, 0.06);
    expect(hands.message(0, 0.07).buttons).toBe(0);
  });
});
