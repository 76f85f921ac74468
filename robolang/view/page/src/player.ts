import type { Run } from "./run";

/** What a player reports: the time moved, the shown range changed, playing began or ended, rows were added. */
export type PlayerEvent = "time" | "range" | "playing" | "grown";

const LEAST_RANGE_S = 0.005;

/** The time that the whole page shows, and the range of time that timeline and charts show. */
export class Player {
  readonly runs: readonly Run[];
  t = 0;
  /** Index of the running statement of the first run. */
  statement = -1;
  playing = false;
  rate = 1;
  end = 0;
  range: [number, number] = [0, 0];
  private readonly listeners = new Map<PlayerEvent, (() => void)[]>();

  constructor(runs: readonly Run[]) {
    this.runs = runs;
    this.end = Math.max(...runs.map((run) => run.end));
    this.range = [0, this.end];
    this.statement = this.first.statements.at(0);
  }

  get first(): Run {
    const run = this.runs[0];
    if (!run) throw new Error("there is no run to show");
    return run;
  }

  get zoomed(): boolean {
    return this.range[0] > 0 || this.range[1] < this.end;
  }

  on(event: PlayerEvent, listener: () => void): void {
    this.listeners.set(event, [...(this.listeners.get(event) ?? []), listener]);
  }

  /** Show a time. `statement` names the statement that is meant where several start at that time. */
  seek(t: number, statement?: number): void {
    this.t = Math.max(0, Math.min(this.end, Number.isFinite(t) ? t : 0));
    this.statement = statement ?? this.first.statements.at(this.t);
    this.emit("time");
  }

  /** Show the start of a statement, and bring it into the shown range. */
  seekStatement(index: number): void {
    const one = this.first.statements.all[index];
    if (!one) return;
    this.seek(one.start_s, index);
    this.reveal(one.start_s);
  }

  /** Move the shown range, in its width, so that it holds a time. */
  reveal(t: number): void {
    const [from, to] = this.range;
    if (t >= from && t <= to) return;
    const width = to - from;
    const start = Math.max(0, Math.min(this.end - width, t - 0.1 * width));
    this.zoom(start, start + width);
  }

  zoom(from = 0, to = this.end): void {
    const low = Math.max(0, Math.min(from, to));
    const high = Math.min(this.end, Math.max(from, to));
    if (high - low < LEAST_RANGE_S) return;
    this.range = [low, high];
    this.emit("range");
  }

  play(): void {
    if (this.t >= this.end - 1e-6) this.seek(0);
    this.reveal(this.t);
    this.playing = true;
    this.emit("playing");
  }

  pause(): void {
    this.playing = false;
    this.emit("playing");
  }

  /** Advance by seconds of wall time while playing. */
  advance(seconds: number): void {
    this.seek(this.t + seconds * this.rate);
    if (this.t > this.range[1]) this.reveal(this.t);
    if (this.t >= this.end) this.pause();
  }

  /** A run that still goes on has new rows: its end moved. */
  extend(): void {
    const whole = !this.zoomed;
    this.end = Math.max(...this.runs.map((run) => run.end));
    if (whole) this.range = [0, this.end];
  }

  /** As `extend`, and everything that shows rows is drawn anew. */
  grow(): void {
    this.extend();
    this.emit("grown");
  }

  private emit(event: PlayerEvent): void {
    for (const listener of this.listeners.get(event) ?? []) listener();
  }
}
