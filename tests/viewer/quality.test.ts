import { isSoftwareRenderer, kQualityLevels, QualityChooser } from "@viewer/scene/quality";

const feed = (chooser: QualityChooser, milliseconds: number, frames: number) => { for (let i = 0; i < frames; ++i) chooser.measured(milliseconds); };

describe("quality", () => {
  it("knows a processor that plays graphics chip by its name", () => {
    expect(isSoftwareRenderer("ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)")).toBe(true);
    expect(isSoftwareRenderer("llvmpipe (LLVM 15.0.6, 256 bits)")).toBe(true);
    expect(isSoftwareRenderer("ANGLE (Intel, Mesa Intel(R) Iris(R) Xe Graphics (TGL GT2), OpenGL 4.6)")).toBe(false);
  });

  it("starts at the lowest level without a graphics chip and stays there", () => {
    const chooser = new QualityChooser(true);
    expect(chooser.current.name).toBe("software");
    feed(chooser, 8, 3000);
    expect(chooser.current.name).toBe("software");
    expect(chooser.current.shadowMap).toBe(0);
    expect(chooser.current.blurSamples).toBe(0);
  });

  it("goes down when frames are slow, step by step", () => {
    const chooser = new QualityChooser(false);
    expect(chooser.current.name).toBe("medium");
    feed(chooser, 40, 45);
    expect(chooser.current.name).toBe("low");
    feed(chooser, 40, 45);
    expect(chooser.current.name).toBe("software");
    feed(chooser, 40, 450);
    expect(chooser.current.name).toBe("software");
  });

  it("goes up slowly, and not back to what was too slow", () => {
    const chooser = new QualityChooser(false);
    feed(chooser, 16.7, 45 * 5);
    expect(chooser.current.name).toBe("medium");
    feed(chooser, 16.7, 45);
    expect(chooser.current.name).toBe("high");
    feed(chooser, 30, 45);
    expect(chooser.current.name).toBe("medium");
    feed(chooser, 16.7, 45 * 40);
    expect(chooser.current.name).toBe("medium");
  });

  it("ignores a sleeping page and single hitches", () => {
    const chooser = new QualityChooser(false);
    for (let i = 0; i < 450; ++i) chooser.measured(i % 10 === 0 ? 90 : 16.7);
    feed(chooser, 4000, 450);
    expect(chooser.current.name).not.toBe("low");
  });

  it("leaves a level alone that was chosen by hand, until it is automatic again", () => {
    const chooser = new QualityChooser(true);
    chooser.choose("high");
    feed(chooser, 300, 450);
    expect(chooser.current.name).toBe("high");
    chooser.choose("auto");
    expect(chooser.current.name).toBe("software");
  });

  it("costs less from level to level downwards", () => {
    for (let i = 1; i < kQualityLevels.length; ++i) {
      expect(kQualityLevels[i].shadowMap).toBeGreaterThan(kQualityLevels[i - 1].shadowMap);
      expect(kQualityLevels[i].blurSamples).toBeGreaterThanOrEqual(kQualityLevels[i - 1].blurSamples);
      expect(kQualityLevels[i].pixelRatio).toBeGreaterThanOrEqual(kQualityLevels[i - 1].pixelRatio);
    }
  });
});
