// Paths of the instrument tips in space: a small turning picture with axes in millimetres. Drawn only when something changes.
import type { Path } from "../messages";
import { h, setText } from "./dom";
import { toolTitle } from "./panels";

const kColours = ["#6fd3c0", "#f2b04e", "#b79cf0"];
const kDashes = [[], [7, 4], [2, 3]];

export class PathPlot {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": "Paths of the instrument tips in space. Arrow keys turn the picture." });
  private readonly note = h("p", { class: "quiet" }, "");
  private turn = 0.6;
  private rise = 0.5;
  private readonly centre = [0, 0, 0];
  private readonly low = [Infinity, Infinity, Infinity];
  private readonly high = [-Infinity, -Infinity, -Infinity];
  private readonly observer: ResizeObserver;

  constructor(private readonly paths: readonly Path[]) {
    for (const path of paths) path.positions.forEach((value, i) => {
      const axis = i % 3;
      this.low[axis] = Math.min(this.low[axis], 1000 * value);
      this.high[axis] = Math.max(this.high[axis], 1000 * value);
    });
    for (let k = 0; k < 3; ++k) this.centre[k] = (this.low[k] + this.high[k]) / 2;
    const legend = h("ul", { class: "legend" }, ...paths.map((path, i) => h("li", {}, h("span", { class: `swatch s${i}` }), toolTitle(path.name))));
    this.element = h("div", { class: "pathplot" }, this.canvas, legend, this.note);
    this.canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0) return;
      this.rotate(0.01 * event.movementX, 0.01 * event.movementY);
    });
    this.canvas.addEventListener("keydown", (event) => {
      const step: Record<string, [number, number]> = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] };
      if (!(event.key in step)) return;
      event.preventDefault();
      this.rotate(...step[event.key]);
    });
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(this.canvas);
    setText(this.note, "Drag or arrow keys turn the picture. Grid: the work surface, one square is 1 mm.");
  }

  dispose(): void { this.observer.disconnect(); }

  private rotate(turn: number, rise: number): void {
    this.turn += turn;
    this.rise = Math.min(1.5, Math.max(-0.2, this.rise + rise));
    this.draw();
  }

  /// Millimetres to picture, seen from far away.
  private project(x: number, y: number, z: number, scale: number, width: number, height: number): [number, number] {
    const a = x - this.centre[0], b = y - this.centre[1], c = z - this.centre[2];
    const u = Math.cos(this.turn) * a + Math.sin(this.turn) * b, v = -Math.sin(this.turn) * a + Math.cos(this.turn) * b;
    return [width / 2 + scale * u, height / 2 - scale * (Math.sin(this.rise) * v + Math.cos(this.rise) * c)];
  }

  /// Largest scale [pixel/mm] at which the box round all paths is in the picture, with room for the words.
  private fitting(width: number, height: number): number {
    let across = 1, up = 1;
    for (let corner = 0; corner < 8; ++corner) {
      const [x, y, z] = [0, 1, 2].map((k) => ((corner >> k) & 1 ? this.high[k] : this.low[k]));
      const [u, v] = this.project(x, y, z, 1, 0, 0);
      across = Math.max(across, Math.abs(u));
      up = Math.max(up, Math.abs(v));
    }
    return 0.5 * Math.min((width - 60) / across, (height - 50) / up);
  }

  private draw(): void {
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (width === 0 || !Number.isFinite(this.low[0])) return;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const g = this.canvas.getContext("2d")!;
    g.scale(ratio, ratio);
    const scale = this.fitting(width, height);
    const to = (x: number, y: number, z: number) => this.project(x, y, z, scale, width, height);
    this.drawGrid(g, to);
    this.paths.forEach((path, i) => {
      g.beginPath();
      g.strokeStyle = kColours[i % kColours.length];
      g.setLineDash(kDashes[i % kDashes.length]);
      g.lineWidth = 1.5;
      for (let k = 0; k + 2 < path.positions.length; k += 3) {
        const [x, y] = to(1000 * path.positions[k], 1000 * path.positions[k + 1], 1000 * path.positions[k + 2]);
        if (k === 0) g.moveTo(x, y);
        else g.lineTo(x, y);
      }
      g.stroke();
      this.drawEnds(g, path, i, to);
    });
  }

  private drawGrid(g: CanvasRenderingContext2D, to: (x: number, y: number, z: number) => [number, number]): void {
    const x0 = Math.floor(this.low[0]), x1 = Math.ceil(this.high[0]), y0 = Math.floor(this.low[1]), y1 = Math.ceil(this.high[1]);
    const z = this.low[2];
    g.setLineDash([]);
    g.lineWidth = 1;
    g.strokeStyle = "#ffffff1c";
    g.beginPath();
    for (let x = x0; x <= x1; ++x) { g.moveTo(...to(x, y0, z)); g.lineTo(...to(x, y1, z)); }
    for (let y = y0; y <= y1; ++y) { g.moveTo(...to(x0, y, z)); g.lineTo(...to(x1, y, z)); }
    g.stroke();
    g.fillStyle = g.strokeStyle = "#c9d8d6";
    g.font = "12px system-ui, sans-serif";
    const length = Math.max(2, Math.round((x1 - x0) / 4));
    for (const [dx, dy, dz, name] of [[1, 0, 0, "x right"], [0, 1, 0, "y away"], [0, 0, 1, "z up"]] as const) {
      const end = to(x0 + dx * length, y0 + dy * length, z + dz * length);
      g.beginPath();
      g.moveTo(...to(x0, y0, z));
      g.lineTo(...end);
      g.stroke();
      g.fillText(`${name} ${length} mm`, end[0] + 4, end[1] - 4);
    }
  }

  /// Circle where the path starts, square where it ends.
  private drawEnds(g: CanvasRenderingContext2D, path: Path, index: number, to: (x: number, y: number, z: number) => [number, number]): void {
    const n = path.positions.length;
    if (n < 3) return;
    g.setLineDash([]);
    g.fillStyle = kColours[index % kColours.length];
    const [sx, sy] = to(1000 * path.positions[0], 1000 * path.positions[1], 1000 * path.positions[2]);
    const [ex, ey] = to(1000 * path.positions[n - 3], 1000 * path.positions[n - 2], 1000 * path.positions[n - 1]);
    g.beginPath();
    g.arc(sx, sy, 4.5, 0, 2 * Math.PI);
    g.fill();
    g.fillRect(ex - 4, ey - 4, 8, 8);
  }
}
