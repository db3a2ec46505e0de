// Draws the stage as it is seen through the microscope: one or two eyes, zoom, focus, quality.
import * as THREE from "three";
import type { Frame, Scene } from "../messages";
import { FinishPass } from "./finish_pass";
import { blurDiameter, eyeAt, fieldDiameter, magnificationFor, magnificationAtFirst, kMagnificationBrain, kMagnificationStart, kTilt, kTiltBrain, kWorkingDistance, openingAngle, type OpticsState } from "./optics";
import { isSoftwareRenderer, QualityChooser } from "./quality";
import { Stage } from "./stage";

export type StereoMode = "mono" | "side-by-side" | "anaglyph";

const kThinnest = 0.95; // [CSS pixel], least radius of the thread on the page
const kNear = 80, kFar = 320; // [mm]

export class Microscope {
  readonly stage: Stage;
  readonly quality: QualityChooser;
  readonly rendererName: string;
  private start = kMagnificationStart;
  private unseen: Scene | null = null; // of which no frame has been seen yet
  readonly optics: OpticsState = { magnification: kMagnificationStart, focus: 0, centre: [0, 0], tilt: kTilt, eyeDistance: 22 };
  stereo: StereoMode = "mono";
  lastFrameTime = 0; // [ms], from one drawn frame to the next
  private readonly renderer: THREE.WebGLRenderer;
  private readonly camera = new THREE.PerspectiveCamera(5, 1, kNear, kFar);
  private readonly finish = new FinishPass();
  private picture: THREE.WebGLRenderTarget | null = null;
  private readonly eyes: THREE.WebGLRenderTarget[] = [];
  private diameter = 0; // [CSS pixel]
  private configured = "";
  private readonly target = new THREE.Vector3();
  private readonly eye = new THREE.Vector3();

  constructor(readonly canvas: HTMLCanvasElement) {
    this.rendererName = probeRenderer();
    this.quality = new QualityChooser(isSoftwareRenderer(this.rendererName));
    const antialias = !this.quality.software; // smooth edges cost a processor as much as all the rest
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias, stencil: true, powerPreference: "high-performance" });
    this.renderer.toneMapping = THREE.ACESFilmicToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.autoClear = true;
    this.stage = new Stage(this.renderer, this.quality.current.painted);
  }

  describe(scene: Scene): void {
    this.stage.describe(scene);
    this.optics.focus = this.stage.focusHeight;
    this.optics.centre = [...this.stage.centre];
    this.optics.tilt = scene.brain && scene.brain.bone === null ? kTiltBrain : kTilt; // below a lobe one looks along the bone
    const start = scene.brain ? kMagnificationBrain : scene.tissue ? magnificationFor(...extent(scene.tissue.rest)) : kMagnificationStart;
    if (start !== this.start) this.optics.magnification = this.start = start;
    this.unseen = scene;
  }

  /// The first frame says where needle and instruments are; they must be in the picture to be taken and moved.
  private showFirst(frame: Frame): void {
    if (!this.unseen) return;
    const start = magnificationAtFirst(this.start, this.unseen, frame, this.optics.centre);
    this.unseen = null;
    if (this.optics.magnification === this.start) this.optics.magnification = start;
    this.start = start;
  }

  /// Magnification that a scene of this kind begins with.
  get startMagnification(): number { return this.start; }

  update(frame: Frame): void {
    this.showFirst(frame);
    this.stage.paint(this.quality.current.painted);
    this.stage.update(frame, kThinnest * this.millimetresPerPixel);
  }

  /// `diameter`: of the round field on the page [CSS pixel].
  resize(diameter: number): void { this.diameter = Math.max(64, Math.round(diameter)); }

  /// Millimetres in the focal plane for one CSS pixel.
  get millimetresPerPixel(): number { return fieldDiameter(this.optics.magnification) / Math.max(1, this.diameter); }

  draw(): void {
    const level = this.quality.current;
    this.configure();
    const renderer = this.renderer;
    const middle = eyeAt(this.optics, 0);
    this.target.set(...middle.target);
    this.eye.set(...middle.position);
    this.stage.aim(this.target, this.eye, fieldDiameter(this.optics.magnification), level.shadowMap > 0, Math.max(1, level.shadowMap));
    if (this.stereo === "mono") this.drawEye(0, null);
    else if (this.stereo === "side-by-side") this.drawPair();
    else {
      this.drawEye(-1, this.eyes[0]);
      this.drawEye(1, this.eyes[1]);
      renderer.setRenderTarget(null);
      this.finish.mergeEyes(renderer, this.eyes[0], this.eyes[1]);
    }
  }

  /// The way through the tissue nearest to a point of the picture (-1 to 1, y up), within a fiftieth of the field; -1: none. One eye only.
  passAt(x: number, y: number): number {
    if (this.stereo === "side-by-side") return -1;
    this.place(0);
    this.camera.updateMatrixWorld();
    let nearest = 0.04, found = -1;
    this.stage.passes().forEach((places, k) => {
      for (const place of places) {
        const at = place.project(this.camera), distance = Math.hypot(at.x - x, at.y - y);
        if (distance < nearest) { nearest = distance; found = k; }
      }
    });
    return found;
  }

  dispose(): void {
    this.picture?.dispose();
    for (const eye of this.eyes) eye.dispose();
    this.renderer.dispose();
  }

  private drawPair(): void {
    const size = this.diameter;
    for (const side of [-1, 1] as const) {
      this.renderer.setViewport(side < 0 ? 0 : size, 0, size, size);
      this.renderer.setScissor(side < 0 ? 0 : size, 0, size, size);
      this.renderer.setScissorTest(true);
      this.drawEye(side, null);
    }
    this.renderer.setScissorTest(false);
    this.renderer.setViewport(0, 0, 2 * size, size);
  }

  private drawEye(side: -1 | 0 | 1, target: THREE.WebGLRenderTarget | null): void {
    this.place(side);
    const renderer = this.renderer;
    if (!this.picture) { // straight to the page: no depth of field at this level
      renderer.setRenderTarget(target);
      renderer.render(this.stage.scene, this.camera);
      return;
    }
    renderer.setRenderTarget(this.picture);
    renderer.render(this.stage.scene, this.camera);
    const pixelsPerMm = this.picture.height / fieldDiameter(this.optics.magnification);
    // radius in pixels of |d - focus| / d; the same law as blurDiameter() in optics.ts
    const blurScale = 0.5 * blurDiameter(1) * (kWorkingDistance + 1) * pixelsPerMm;
    this.finish.develop(renderer, this.picture, target, this.camera, kWorkingDistance, blurScale);
  }

  private place(side: -1 | 0 | 1): void {
    const eye = eyeAt(this.optics, side);
    const camera = this.camera;
    camera.up.set(0, 1, 0);
    camera.position.set(...eye.position);
    camera.lookAt(...eye.target);
    camera.fov = THREE.MathUtils.radToDeg(openingAngle(this.optics.magnification));
    camera.updateProjectionMatrix();
    camera.projectionMatrix.elements[8] = 2 * eye.shift;
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  }

  /// Makes canvas and buffers fit size, stereo mode and quality; does nothing while these stay the same.
  private configure(): void {
    const level = this.quality.current;
    const ratio = Math.min(level.pixelRatio, level.name === "software" ? level.pixelRatio : window.devicePixelRatio || 1);
    const key = [this.diameter, this.stereo, level.name, ratio].join();
    if (key === this.configured) return;
    this.configured = key;
    const columns = this.stereo === "side-by-side" ? 2 : 1;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(this.diameter * columns, this.diameter, false);
    this.renderer.setViewport(0, 0, this.diameter * columns, this.diameter);
    this.picture?.dispose();
    this.picture = null;
    for (const eye of this.eyes) eye.dispose();
    this.eyes.length = 0;
    const size = Math.round(this.diameter * ratio);
    const needsPicture = level.blurSamples > 0 || this.stereo === "anaglyph";
    if (needsPicture) {
      this.picture = new THREE.WebGLRenderTarget(size, size, { type: THREE.HalfFloatType, samples: level.samples, stencilBuffer: true });
      this.picture.depthTexture = new THREE.DepthTexture(size, size, THREE.UnsignedInt248Type, undefined, undefined, undefined, undefined, undefined, undefined, THREE.DepthStencilFormat);
    }
    if (this.stereo === "anaglyph") {
      for (let k = 0; k < 2; ++k) {
        this.eyes.push(new THREE.WebGLRenderTarget(size, size, { type: THREE.HalfFloatType, depthBuffer: false }));
      }
    }
    this.finish.setSamples(level.blurSamples);
  }
}

/// Length and width [mm] of places [m] seen from above.
function extent(places: readonly number[]): [number, number] {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  places.forEach((value, k) => {
    if (k % 3 === 2) return;
    low[k % 3] = Math.min(low[k % 3], value);
    high[k % 3] = Math.max(high[k % 3], value);
  });
  return [1000 * (high[0] - low[0]), 1000 * (high[1] - low[1])];
}

/// What draws for this browser; asked of a small context of its own, because the choice of the real one depends on it.
function probeRenderer(): string {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) throw new Error("WebGL 2 is missing.");
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return name;
}
