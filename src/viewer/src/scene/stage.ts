// Everything that stands in the illuminated field: background sheet, practice post, instruments, thread and light.
// It is built from the scene message and follows the frames; it works in millimetres and knows nothing of the screen.
import * as THREE from "three";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";
import { RoundedBoxGeometry } from "three/examples/jsm/geometries/RoundedBoxGeometry.js";
import type { Frame, Scene } from "../messages";
import { Brain } from "./brain";
import { FlatShadows } from "./flat_shadows";
import { Instrument } from "./instruments";
import { Laboratory } from "./laboratory";
import { Guides, Needle, Tissue } from "./needle";
import { kSheet, paintedMaterials, physicalMaterials, type Materials } from "./materials";
import { ThreadTube } from "./thread";

const kMm = 1000;
const kShadowReach = 6.5; // [mm], shadows fall into the field from at least this far
const kLight = new THREE.Vector3(-62, 58, 150); // [mm], from the field to the oblique lamp

export class Stage {
  readonly scene = new THREE.Scene();
  readonly key = new THREE.DirectionalLight(0xfff1dd, 2.3);
  private readonly coaxial = new THREE.DirectionalLight(0xf4f8ff, 0.4);
  private readonly ambient = new THREE.AmbientLight(0xffece4, 0); // light thrown about between wet walls
  private readonly content = new THREE.Group();
  private readonly flatShadows = new FlatShadows();
  private materials: Materials;
  private description: Scene | null = null;
  private instruments: Instrument[] = [];
  private thread: ThreadTube | null = null;
  private brain: Brain | null = null;
  private laboratory: Laboratory | null = null;
  private needle: Needle | null = null;
  private tissue: Tissue | null = null;
  private marked: number[] = [];
  private guides: Guides | null = null;
  private guidesShown = false;
  private readonly points: { array: Float64Array } = { array: new Float64Array(0) };
  private gaps: number[] = [];
  private threadRadius = 0.0125;
  private shadowSpan = 0;
  floorHeight = 0; // [mm]
  centre: [number, number] = [0, 0]; // [mm], middle of the field at the start
  focusHeight = 0; // [mm], where a trainee would focus: the top of the post

  /// `painted`: cheap materials for a machine without a graphics chip.
  constructor(private readonly renderer: THREE.WebGLRenderer, private painted: boolean) {
    this.scene.background = new THREE.Color(0x020303);
    this.materials = this.makeMaterials();
    this.key.castShadow = true;
    this.key.shadow.bias = -0.0004;
    this.key.shadow.normalBias = 0.012;
    this.key.shadow.radius = 3.2;
    this.scene.add(this.key, this.key.target, this.coaxial, this.coaxial.target, this.ambient, this.content, this.flatShadows.group);
  }

  /// Exchanges the materials; the next frame fills the scene again.
  paint(painted: boolean): void {
    if (painted === this.painted) return;
    this.painted = painted;
    this.materials = this.makeMaterials();
    if (this.description) this.describe(this.description);
  }

  private makeMaterials(): Materials {
    if (this.painted) return paintedMaterials();
    if (!this.scene.environment) this.scene.environment = this.roomLight();
    return physicalMaterials();
  }

  /// Light of a room from all sides, so that metal has something to mirror.
  private roomLight(): THREE.Texture {
    const room = new RoomEnvironment(), generator = new THREE.PMREMGenerator(this.renderer);
    const { texture } = generator.fromScene(room, 0.03);
    generator.dispose();
    room.dispose();
    this.scene.environmentIntensity = 0.36;
    return texture;
  }

  describe(message: Scene): void {
    this.description = message;
    this.clear();
    this.floorHeight = message.floor_height * kMm;
    this.focusHeight = message.post ? (message.post.position[2] + message.post.radius) * kMm : this.floorHeight;
    this.centre = message.post ? [message.post.position[0] * kMm, message.post.position[1] * kMm] : [0, 0];
    if (message.field) {
      this.centre = [message.field[0] * kMm, message.field[1] * kMm];
      this.focusHeight = message.field[2] * kMm;
    }
    if (message.brain) this.focusHeight = 0;
    this.key.intensity = message.brain ? 1.7 : 2.3; // into a fissure light comes along the view
    this.coaxial.intensity = message.brain ? 1.1 : 0.4;
    this.ambient.intensity = message.brain ? (this.painted ? 0.7 : 0.35) : 0;
    this.threadRadius = message.thread_radius * kMm;
    if (message.brain) this.addDepth();
    else this.addSheet();
    for (const bar of [message.post, message.base]) if (bar) this.addBar(bar);
    if (message.post) this.addStands(message.post);
    this.addNotch(message.notch ?? []);
    for (const bar of message.frame ?? []) this.addBar(bar);
    this.brain = message.brain ? new Brain(message.brain, this.painted) : null;
    if (this.brain) this.content.add(this.brain.group);
    this.instruments = (this.brain ? [] : message.tools).map((shape, index) => new Instrument(shape, index, this.materials));
    for (const instrument of this.instruments) this.content.add(instrument.group);
    this.thread = new ThreadTube(Math.max(2, message.capacity), this.materials.thread);
    this.points.array = new Float64Array(3 * Math.max(2, message.capacity));
    this.content.add(this.thread.mesh);
    this.laboratory = new Laboratory(message, this.materials);
    this.content.add(this.laboratory.group);
    this.needle = message.needle ? new Needle(message.needle, this.materials) : null;
    if (this.needle) this.content.add(this.needle.mesh);
    this.tissue = message.tissue ? new Tissue(message.tissue, this.painted, this.materials, this.floorHeight) : null;
    if (this.tissue) this.content.add(this.tissue.group);
    this.tissue?.mark(this.marked);
    this.guides = message.guides?.length && message.tissue ? new Guides(message.guides, message.tissue.rest) : null;
    if (this.guides) this.content.add(this.guides.group);
    this.showGuides(this.guidesShown);
    this.flatShadows.follow(this.content);
  }

  /// `thinnest` [mm]: least radius drawn, so that the thread does not fall between the pixels at low magnification.
  update(frame: Frame, thinnest: number): void {
    const points = this.points.array;
    const count = Math.min(frame.positions.length, points.length);
    for (let i = 0; i < count; ++i) points[i] = frame.positions[i] * kMm;
    this.gaps.length = 0;
    if (frame.break_edge >= 0) this.gaps.push(frame.break_edge);
    for (const edge of frame.cuts) this.gaps.push(edge);
    this.thread?.update(points, Math.floor(count / 3), Math.max(this.threadRadius, thinnest), this.gaps);
    this.brain?.update(frame);
    for (let i = 0; i < this.instruments.length && i < frame.tools.length; ++i) this.instruments[i].update(frame.tools[i]);
    this.laboratory?.update(frame);
    if (frame.needle) this.needle?.update(frame.needle);
    if (frame.tissue) this.tissue?.update(frame.tissue, frame.time);
    this.tissue?.colour(frame.overlay ?? null);
    if (frame.tissue) this.guides?.update(frame.tissue, frame.overlay != null);
  }

  /// Marks ways through the tissue until others are marked.
  mark(passes: number[]): void {
    this.marked = passes;
    this.tissue?.mark(passes);
  }

  showGuides(on: boolean): void {
    this.guidesShown = on;
    if (this.guides) this.guides.group.visible = on || this.guides.printed;
  }

  /// Places in the field where each way through the tissue begins and ends [mm].
  passes(): THREE.Vector3[][] { return this.tissue?.passes() ?? []; }

  /// Light follows the microscope: an oblique lamp beside the objective for the shadows and a weak one along the view.
  aim(target: THREE.Vector3, eye: THREE.Vector3, field: number, shadows: boolean, mapSize: number): void {
    this.key.target.position.copy(target);
    this.key.position.copy(target).add(kLight);
    this.coaxial.target.position.copy(target);
    this.coaxial.position.copy(eye);
    const span = Math.max(kShadowReach, 0.62 * field);
    const shadow = this.key.shadow;
    this.key.castShadow = shadows;
    this.flatShadows.group.visible = !shadows && this.brain === null;
    if (this.flatShadows.group.visible) this.flatShadows.update(kLight, this.floorHeight);
    if (shadow.mapSize.x !== mapSize) {
      shadow.mapSize.set(mapSize, mapSize);
      shadow.map?.dispose();
      shadow.map = null;
    }
    if (Math.abs(span - this.shadowSpan) < 1e-6) return;
    this.shadowSpan = span;
    const camera = shadow.camera;
    camera.left = camera.bottom = -span;
    camera.right = camera.top = span;
    camera.near = 110;
    camera.far = 230;
    camera.updateProjectionMatrix();
  }

  private clear(): void {
    this.content.traverse((object) => {
      if (object instanceof THREE.Mesh) object.geometry.dispose();
    });
    this.content.clear();
    this.instruments = [];
    this.thread = null;
    this.brain = null;
    this.laboratory = null;
    this.needle = null;
    this.tissue = null;
    this.guides = null;
  }

  private addSheet(): void {
    const sheet = new THREE.Mesh(new THREE.PlaneGeometry(kSheet, kSheet), this.materials.sheet);
    sheet.position.z = this.floorHeight;
    sheet.receiveShadow = true;
    this.content.add(sheet);
  }

  /// What is seen past the tissue of a brain: nothing that is lit.
  private addDepth(): void {
    const depth = new THREE.Mesh(new THREE.PlaneGeometry(2 * kSheet, 2 * kSheet), new THREE.MeshBasicMaterial({ color: 0x1c0b0a }));
    depth.position.z = this.floorHeight;
    this.content.add(depth);
  }

  private addBar(bar: NonNullable<Scene["post"]>): void {
    const geometry = new THREE.CapsuleGeometry(bar.radius * kMm, 2 * bar.half_length * kMm, 16, 48, 1);
    const mesh = new THREE.Mesh(geometry, this.materials.post);
    mesh.position.set(...bar.position).multiplyScalar(kMm);
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3(...bar.axis).normalize());
    mesh.castShadow = mesh.receiveShadow = true;
    this.content.add(mesh);
  }

  /// The bars of the notch, and for the eye a peg below them.
  private addNotch(bars: NonNullable<Scene["post"]>[]): void {
    const first = bars[0];
    if (!first) return;
    for (const bar of bars) this.addBar(bar);
    const low = new THREE.Vector3(...first.position).addScaledVector(new THREE.Vector3(...first.axis).normalize(), -first.half_length).multiplyScalar(kMm);
    const height = low.z - this.floorHeight;
    const peg = new THREE.Mesh(new THREE.CylinderGeometry(2 * first.radius * kMm, 3 * first.radius * kMm, height, 32), this.materials.clamp);
    peg.rotation.x = Math.PI / 2;
    peg.position.set(low.x, low.y, this.floorHeight + height / 2);
    peg.castShadow = peg.receiveShadow = true;
    this.content.add(peg);
  }

  /// Clamps and feet at both ends of the post. Only for the eye: they stand where the bars end and the thread never is.
  private addStands(post: NonNullable<Scene["post"]>): void {
    const radius = post.radius * kMm;
    const axis = new THREE.Vector3(...post.axis).normalize();
    for (const end of [-1, 1]) {
      const at = new THREE.Vector3(...post.position).addScaledVector(axis, end * post.half_length).multiplyScalar(kMm);
      const height = at.z + 1.6 * radius - this.floorHeight;
      const clamp = new THREE.Mesh(new RoundedBoxGeometry(3.6 * radius, 2.2 * radius, height, 5, 0.45 * radius), this.materials.clamp);
      clamp.position.set(at.x, at.y, this.floorHeight + height / 2);
      clamp.rotation.z = Math.atan2(axis.y, axis.x) - Math.PI / 2;
      const screw = new THREE.Mesh(new THREE.CylinderGeometry(0.75 * radius, 0.75 * radius, 0.3 * radius, 32), this.materials.black);
      screw.rotation.x = Math.PI / 2;
      screw.position.set(at.x, at.y, at.z + 1.65 * radius);
      const foot = new THREE.Mesh(new THREE.CylinderGeometry(4.6 * radius, 5 * radius, 0.8 * radius, 64), this.materials.black);
      foot.rotation.x = Math.PI / 2;
      foot.position.set(at.x, at.y, this.floorHeight + 0.4 * radius);
      for (const part of [clamp, screw, foot]) part.castShadow = part.receiveShadow = true;
      this.content.add(clamp, screw, foot);
    }
  }
}
