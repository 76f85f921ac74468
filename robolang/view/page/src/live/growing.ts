import type { Header, Statement } from "../contract";
import { Run, Signal } from "../run";
import { Statements } from "../statements";
import type { Frame } from "./frame";
import type { Began, Hello } from "./messages";

/** Seconds between two rows; frames come at times of their own and are brought to this grid. */
const GRID_S = 0.016;
/** Frames further apart than this say nothing of the time between them: there is no row, and no curve is drawn. */
const GAP_S = 0.1;
/** About half an hour; of a longer run every second row is kept, then every fourth. */
const MOST_ROWS = 120_000;

/** A run that still goes on: rows are added frame by frame, in bounded memory. */
export class GrowingRun extends Run {
  private readonly growing: ReadonlyMap<string, Signal>;
  private before: Frame | null = null;
  /** Place of the first statement in the run: a page that comes late gets the last ones of very many. */
  private oldest = 0;
  /** The last row is newer than its place on the grid says, and is replaced by the next frame. */
  private ahead = false;

  constructor(header: Header, layout: Hello["layout"]) {
    const signals = new Map<string, Signal>();
    for (const [name, count] of layout) {
      if (name === "line") continue;
      for (const [part, columns] of name === "moved" ? split(count) : ([[name, count]] as const)) {
        if (columns > 0) signals.set(part, new Signal({ base: "frame", t0: 0, dt: GRID_S }, Array.from({ length: columns }, () => new Float32Array(0))));
      }
    }
    super(header, signals);
    this.growing = signals;
  }

  /** Add a frame; one from before the last one takes the run back to its time. */
  add(frame: Frame): void {
    const first = this.any;
    if (!first) return;
    if (this.before !== null && frame.t < this.before.t) this.takeBack(frame.t);
    if (first.rows === 0) for (const signal of this.growing.values()) signal.t0 = frame.t;
    const gap = this.before !== null && frame.t - this.before.t > Math.max(GAP_S, 2 * first.dt);
    // Before a gap the newest row stays a little ahead of its time: it is the only one of its frame.
    if (this.ahead && !gap) this.cut(first.rows - 1);
    for (let t = this.next; t < frame.t - 1e-9; t = this.next) {
      this.append(gap ? () => [] : this.between(frame, t));
      if (first.rows > MOST_ROWS) this.halve();
    }
    // The newest row stands at its place on the grid or a little before it, so that what rests is shown as it rests.
    this.ahead = this.next > frame.t + 1e-9;
    this.append((name) => valuesOf(frame, name));
    this.before = frame;
    this.end = Math.max(0, this.next - first.dt);
    if (first.rows > MOST_ROWS) this.halve();
  }

  /** Statements that have begun; each lasts until the next one. */
  began({ from, rows }: Began): void {
    const kept = this.statements.all.slice(0, Math.max(0, from - this.oldest));
    if (kept.length === 0) this.oldest = from;
    this.statements = new Statements(this.lasting([...kept, ...rows.map((row) => ({ ...row, duration_s: 0 }))]));
  }

  /** Let the running statement last until now. */
  stretch(): void {
    this.statements = new Statements(this.lasting(this.statements.all));
  }

  override recorded(t: number): number {
    const signal = this.any;
    const values = signal?.columns[0];
    if (!signal || !values || signal.rows === 0) return t;
    if (t < signal.t0) return signal.t0;
    let row = signal.row(t);
    if (!Number.isNaN(values[row] ?? NaN)) return t;
    while (row > 0 && Number.isNaN(values[row] ?? NaN)) row -= 1;
    return signal.t0 + row * signal.dt;
  }

  override get thinned(): string {
    const dt = this.any?.dt ?? GRID_S;
    return dt > GRID_S ? `Of a long run one value every ${Math.round(dt * 1000)} ms is kept.` : "";
  }

  private get any(): Signal | undefined {
    return this.growing.get("q_link");
  }

  /** Time of the next row. */
  private get next(): number {
    const signal = this.any;
    return signal ? signal.t0 + signal.rows * signal.dt : 0;
  }

  private lasting(all: readonly Statement[]): Statement[] {
    return all.map((one, k) => ({ ...one, duration_s: Math.max(0, (all[k + 1]?.start_s ?? Math.max(this.end, one.start_s)) - one.start_s) }));
  }

  private between(frame: Frame, t: number): (name: string) => ArrayLike<number> {
    const before = this.before ?? frame;
    const share = frame.t > before.t ? (t - before.t) / (frame.t - before.t) : 1;
    return (name) => {
      const [from, to] = [valuesOf(before, name), valuesOf(frame, name)];
      return to.map((value, k) => (from[k] ?? value) + share * (value - (from[k] ?? value)));
    };
  }

  private append(values: (name: string) => ArrayLike<number>): void {
    for (const [name, signal] of this.growing) signal.append(values(name));
  }

  private cut(rows: number): void {
    for (const signal of this.growing.values()) signal.rows = Math.max(0, Math.min(signal.rows, rows));
  }

  private takeBack(t: number): void {
    const signal = this.any;
    if (signal) this.cut(Math.max(0, Math.floor((t - signal.t0) / signal.dt)));
    this.ahead = false;
    this.before = null;
  }

  private halve(): void {
    for (const signal of this.growing.values()) signal.halve();
    this.ahead = false;
  }
}

/** The parts and the pads of what moved. */
function split(count: number): readonly (readonly [string, number])[] {
  return [
    ["parts", count - 2],
    ["fingers", 2],
  ];
}

function valuesOf(frame: Frame, name: string): Float32Array {
  const moved = frame.values.get("moved");
  if (name === "parts") return moved?.subarray(0, -2) ?? new Float32Array(0);
  if (name === "fingers") return moved?.subarray(-2) ?? new Float32Array(0);
  return frame.values.get(name) ?? new Float32Array(0);
}
