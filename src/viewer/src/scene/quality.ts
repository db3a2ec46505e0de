// Picture quality chosen by the machine's own speed. Pure logic: fed with frame times, it says which level to draw at.

export type QualityName = "software" | "low" | "medium" | "high";

export interface QualityLevel {
  name: QualityName;
  pixelRatio: number; // largest used, further limited by the screen's own
  shadowMap: number; // [texel], 0 = no shadows
  samples: number; // multi-sampling of the picture
  blurSamples: number; // depth of field, 0 = none
  painted: boolean; // cheap materials
}

export const kQualityLevels: readonly QualityLevel[] = [
  { name: "software", pixelRatio: 0.75, shadowMap: 0, samples: 0, blurSamples: 0, painted: true },
  { name: "low", pixelRatio: 1, shadowMap: 1024, samples: 0, blurSamples: 0, painted: false },
  { name: "medium", pixelRatio: 1, shadowMap: 2048, samples: 4, blurSamples: 24, painted: false },
  { name: "high", pixelRatio: 2, shadowMap: 4096, samples: 4, blurSamples: 48, painted: false },
];

/// True where the picture is computed by the processor instead of a graphics chip.
export function isSoftwareRenderer(description: string): boolean {
  return /swiftshader|llvmpipe|softpipe|software|basic render|subzero/i.test(description);
}

const kWindow = 45; // frames looked at before a decision
const kSlow = 21; // [ms], slower than this: one level down
const kFast = 12; // [ms], faster than this for long: one level up
const kFastWindows = 6; // windows in a row before going up

/// Goes down quickly, up slowly and never back to a level that was too slow before.
export class QualityChooser {
  private level: number;
  private ceiling: number;
  private readonly times: number[] = [];
  private fastWindows = 0;
  private fixed = false;

  constructor(readonly software: boolean) {
    this.ceiling = software ? 0 : kQualityLevels.length - 1;
    this.level = software ? 0 : 2;
  }

  get current(): QualityLevel { return kQualityLevels[this.level]; }
  get automatic(): boolean { return !this.fixed; }

  /// Chooses a level by name, or hands the choice back to the measurement.
  choose(name: QualityName | "auto"): void {
    this.fixed = name !== "auto";
    this.times.length = 0;
    this.fastWindows = 0;
    if (name === "auto") {
      this.ceiling = this.software ? 0 : kQualityLevels.length - 1;
      this.level = this.software ? 0 : Math.min(this.level, 2);
    } else {
      this.level = kQualityLevels.findIndex((level) => level.name === name);
    }
  }

  /// `milliseconds`: time from one drawn frame to the next. True when the level has changed.
  measured(milliseconds: number): boolean {
    if (this.fixed || milliseconds > 500) return false; // a hidden or sleeping page says nothing of the speed
    this.times.push(milliseconds);
    if (this.times.length < kWindow) return false;
    const sorted = [...this.times].sort((a, b) => a - b);
    this.times.length = 0;
    const typical = sorted[Math.floor(0.75 * kWindow)];
    if (typical > kSlow && this.level > 0) {
      this.ceiling = --this.level;
      this.fastWindows = 0;
      return true;
    }
    this.fastWindows = typical < kFast || typical <= 17.5 ? this.fastWindows + 1 : 0;
    if (this.fastWindows < kFastWindows || this.level >= this.ceiling) return false;
    this.fastWindows = 0;
    ++this.level;
    return true;
  }
}
