import { Color, Vector3 } from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { token } from "../dom";
import type { Run } from "../run";

/** A wide line costs some 30 triangles a point; more points than these show nothing more. */
const MOST_POINTS = 1800;
/** A turn by more than this angle keeps its point. */
const CORNER_COS = Math.cos((8 * Math.PI) / 180);

/** The path of the tool point, coloured by its error; the error can be drawn larger than it was. */
export class ToolPath {
  readonly line: LineSegments2;
  private readonly run: Run;
  private truth: readonly Float32Array[];
  private samples: readonly number[];

  /** `truth`: x, y, z of the true tool point at the rows of the signal `tool`. */
  constructor(run: Run, truth: Float32Array[]) {
    this.run = run;
    this.truth = truth;
    this.samples = thinPath(truth, MOST_POINTS);
    this.line = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ linewidth: 3.5, vertexColors: true }));
  }

  /** Take the rows there are now, of a run that still goes on. */
  grow(): void {
    const tool = this.run.signals.get("tool");
    if (!tool) return;
    this.truth = tool.columns.map((column) => column.subarray(0, tool.rows));
    this.samples = thinPath(this.truth, MOST_POINTS);
  }

  /** Draw with the error `scale` times its size; `top` is the error of the last colour, m. */
  draw(scale: number, top: number): void {
    const ramp = rampColours();
    const command = this.run.signals.get("tool_cmd");
    const tool = this.run.signals.get("tool");
    const error = this.run.signals.get("tool_error");
    const places: number[] = [];
    const colours: number[] = [];
    const colour = new Color();
    let before = 0;
    this.samples.forEach((row, k) => {
      const t = tool ? tool.t0 + row * tool.dt : 0;
      for (let j = 0; j < 3; j++) {
        const true_ = this.truth[j]?.[row] ?? 0;
        const wanted = command?.columns[j]?.[command.row(t)] ?? true_;
        places.push(wanted + scale * (true_ - wanted));
      }
      // No peak between two samples is without colour; after the last one the run may have ticks of its own.
      const [, most] = error?.range((row) => error.columns[0]?.[row] ?? NaN, before, k + 1 < this.samples.length ? t : Infinity) ?? [0, 0];
      onRamp(ramp, top > 0 ? most / top : 0, colour);
      colours.push(colour.r, colour.g, colour.b);
      before = t;
    });
    this.line.geometry.dispose();
    this.line.geometry = new LineSegmentsGeometry();
    const starts = this.samples.flatMap((row, k) => (k > 0 && !this.broken(this.samples[k - 1] ?? row, row) ? [k - 1] : []));
    if (starts.length === 0) return;
    this.line.geometry.setPositions(starts.flatMap((k) => places.slice(3 * k, 3 * k + 6)));
    this.line.geometry.setColors(starts.flatMap((k) => colours.slice(3 * k, 3 * k + 6)));
  }

  /** Whether the path has a gap between two rows. */
  private broken(from: number, to: number): boolean {
    for (let row = from + 1; row < to; row++) if (missing(this.truth, row)) return true;
    return false;
  }
}

const missing = (xyz: readonly Float32Array[], row: number): boolean => Number.isNaN(xyz[0]?.[row] ?? NaN);

/** Rows that keep the form of a path: evenly spaced along it, its corners, and both ends of each gap. */
export function thinPath(xyz: readonly Float32Array[], most: number): number[] {
  const rows = xyz[0]?.length ?? 0;
  const point = (row: number, out: Vector3): Vector3 => out.set(xyz[0]?.[row] ?? 0, xyz[1]?.[row] ?? 0, xyz[2]?.[row] ?? 0);
  const [kept, here, ahead, before] = [new Vector3(), new Vector3(), new Vector3(), new Vector3()];
  let length = 0;
  for (let row = 1; row < rows; row++) length += point(row - 1, kept).distanceTo(point(row, here)) || 0;
  const spacing = Math.max(length / (0.75 * most), 1e-6);
  const out: number[] = [];
  point(0, kept);
  for (let row = 0; row < rows; row++) {
    point(row, here);
    const gone = here.distanceTo(kept);
    const corner = gone > 0.2 * spacing && row + 1 < rows && turns(before.subVectors(here, kept), point(row + 1, ahead).sub(here));
    if (missing(xyz, row)) continue;
    const inside = row > 0 && row < rows - 1 && !missing(xyz, row - 1) && !missing(xyz, row + 1);
    if (inside && gone < spacing && !corner) continue;
    out.push(row);
    kept.copy(here);
  }
  return out.length <= most ? out : Array.from({ length: most }, (_, k) => out[Math.round((k * (out.length - 1)) / (most - 1))] ?? 0);
}

function turns(before: Vector3, ahead: Vector3): boolean {
  return before.dot(ahead) < CORNER_COS * before.length() * ahead.length();
}

function rampColours(): Color[] {
  return [0, 1, 2, 3, 4].map((k) => new Color(token(`--ramp-${k}`)));
}

function onRamp(ramp: readonly Color[], share: number, out: Color): void {
  const x = Math.max(0, Math.min(1, Number.isFinite(share) ? share : 0)) * (ramp.length - 1);
  const k = Math.min(Math.floor(x), ramp.length - 2);
  const [low, high] = [ramp[k], ramp[k + 1]];
  if (low && high) out.lerpColors(low, high, x - k);
}
