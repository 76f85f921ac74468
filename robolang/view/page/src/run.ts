import type { Header, Note, SeriesHead, SignalHead, Statement } from "./contract";
import { Statements } from "./statements";

/** A signal: evenly spaced rows of some columns. NaN: no value. */
export class Signal {
  t0: number;
  dt: number;
  rows: number;
  columns: Float32Array[];
  /** Two rows are the least and the largest value of a bin, each at a time of its own within it. */
  readonly paired: boolean;

  constructor(head: Pick<SignalHead, "base" | "t0" | "dt">, columns: Float32Array[]) {
    this.paired = head.base === "pairs";
    this.t0 = head.t0;
    this.dt = head.dt;
    this.columns = columns;
    this.rows = columns[0]?.length ?? 0;
  }

  /** Number of the row at a time, inside the rows there are. */
  row(t: number): number {
    return Math.max(0, Math.min(this.rows - 1, Math.floor((t - this.t0) / this.dt + 1e-6)));
  }

  /** Whether the signal has rows at a time: the shorter of two runs ends before the other, a live page may join late. */
  covers(t: number): boolean {
    return t >= this.t0 - this.dt - 1e-6 && t <= this.t0 + this.rows * this.dt + 1e-6;
  }

  /** Number of the row before a time, and the share of the next one: 0 at the last row. */
  between(t: number): readonly [row: number, share: number] {
    const x = Math.max(0, Math.min(this.rows - 1, (t - this.t0) / this.dt));
    // A time that is that of a row belongs to it, and not to the row before, which may have no value.
    const row = Math.floor(x + 1e-6);
    return [row, Math.max(0, x - row)];
  }

  /** Value of a column at a time, between two rows where both have one. */
  at(column: number, t: number): number {
    const values = this.columns[column];
    if (!values || this.rows === 0) return NaN;
    const [row, share] = this.between(t);
    const here = values[row] ?? NaN;
    const next = share > 0 ? (values[row + 1] ?? NaN) : NaN;
    return Number.isNaN(next) ? here : here + share * (next - here);
  }

  /** Least and largest of the values of rows from one time to another, `t` to `to`; NaN where there is none. Of pairs, those of whole bins. */
  range(valueOf: (row: number) => number, t: number, to = t): readonly [least: number, most: number] {
    const [first, last] = this.paired ? [this.row(t) & ~1, this.row(to) | 1] : [this.row(t), this.row(to)];
    let [least, most] = [NaN, NaN];
    for (let row = first; row <= last && row < this.rows; row++) {
      const value = valueOf(row);
      if (!(value >= least)) least = Number.isNaN(value) ? least : value;
      if (!(value <= most)) most = Number.isNaN(value) ? most : value;
    }
    return [least, most];
  }

  /** Add one row; the columns grow by doubling, for a run that is still going on. */
  append(row: ArrayLike<number>): void {
    if (this.rows >= (this.columns[0]?.length ?? 0)) {
      this.columns = this.columns.map((column) => {
        const wider = new Float32Array(Math.max(1024, 2 * column.length));
        wider.set(column);
        return wider;
      });
    }
    this.columns.forEach((column, k) => (column[this.rows] = row[k] ?? NaN));
    this.rows += 1;
  }

  /** Keep every second row, for a run that is longer than its memory. */
  halve(): void {
    const kept = Math.ceil(this.rows / 2);
    for (const column of this.columns) for (let k = 0; k < kept; k++) column[k] = column[2 * k] ?? NaN;
    this.rows = kept;
    this.dt *= 2;
  }
}

/** A curve of a chart: a column in the unit of the chart, less another one where the series has one. */
export class Curve {
  readonly head: SeriesHead;
  readonly signal: Signal;
  /** Of the rows that there were when the curve was made; a run that goes on has more, and `value` knows them. */
  readonly values: Float32Array;
  private readonly less: Signal | undefined;

  constructor(head: SeriesHead, signal: Signal, less?: Signal) {
    this.head = head;
    this.signal = signal;
    this.less = less;
    const column = signal.columns[head.column] ?? new Float32Array(0);
    // No copy of what is drawn as it is: the columns of a long run are large.
    this.values = head.scale === 1 && !less ? column : Float32Array.from({ length: signal.rows }, (_, row) => this.value(row));
  }

  /** The value of a row, NaN without one. */
  value(row: number): number {
    const { column, scale, minus } = this.head;
    const less = this.less && minus ? (this.less.columns[minus[1]]?.[row] ?? NaN) : 0;
    return ((this.signal.columns[column]?.[row] ?? NaN) - less) * scale;
  }
}

/** One run: its header, its signals by name, its statements. */
export class Run {
  readonly header: Header;
  readonly signals: ReadonlyMap<string, Signal>;
  statements: Statements;
  /** Alarms, warnings and notes; another list where they are others. */
  notes: readonly Note[];
  end: number;

  constructor(header: Header, signals: ReadonlyMap<string, Signal>) {
    this.header = header;
    this.signals = signals;
    this.end = header.duration_s;
    this.notes = header.notes;
    const known: readonly Statement[] = header.meta.report.statements;
    this.statements = new Statements(known.filter((one) => Number.isFinite(one.start_s)));
  }

  /** What a page says of the rows that it does not have; empty: it has all. */
  get thinned(): string {
    return this.header.thinned?.text ?? "";
  }

  /** The time of the newest row that is known at a time; before the first row, the time of that. What has ended is known whole. */
  recorded(t: number): number {
    return t;
  }

  /** The curve of a series, null where the run does not have its signal. */
  curve(head: SeriesHead): Curve | null {
    const signal = this.signals.get(head.signal);
    return signal?.columns[head.column] ? new Curve(head, signal, head.minus ? this.signals.get(head.minus[0]) : undefined) : null;
  }

  /** Largest finite value of the first column of a signal, 0 without one. */
  largest(name: string): number {
    const column = this.signals.get(name)?.columns[0];
    if (!column) return 0;
    let most = 0;
    for (const value of column) if (value > most) most = value;
    return most;
  }
}
