// Short tones for warnings; one pitch pattern per level. Off until the user switches it on.
import type { Warning } from "../messages";

const kTones: Record<Warning["level"], number[]> = { info: [660], warn: [520, 520], danger: [880, 440, 880] };

export class Sound {
  private context: AudioContext | null = null;
  on = localStorage.getItem("filum.sound") === "on";

  toggle(): boolean {
    this.on = !this.on;
    localStorage.setItem("filum.sound", this.on ? "on" : "off");
    if (this.on) this.play("info");
    return this.on;
  }

  play(level: Warning["level"]): void {
    if (!this.on) return;
    this.context ??= new AudioContext();
    const { context } = this;
    kTones[level].forEach((pitch, k) => {
      const from = context.currentTime + 0.14 * k;
      const tone = context.createOscillator(), gain = context.createGain();
      tone.frequency.value = pitch;
      gain.gain.setValueAtTime(0, from);
      gain.gain.linearRampToValueAtTime(0.12, from + 0.01);
      gain.gain.exponentialRampToValueAtTime(0.001, from + 0.12);
      tone.connect(gain).connect(context.destination);
      tone.start(from);
      tone.stop(from + 0.13);
    });
  }
}
