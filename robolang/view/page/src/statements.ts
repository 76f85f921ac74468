import type { Statement } from "./contract";

/** The executed statements in the order of their starts, with look-ups by time and by line. */
export class Statements {
  readonly all: readonly Statement[];
  readonly byLine = new Map<number, number[]>();

  constructor(all: readonly Statement[]) {
    this.all = all;
    all.forEach((one, k) => {
      if (one.line === null) return;
      const known = this.byLine.get(one.line);
      if (known) known.push(k);
      else this.byLine.set(one.line, [k]);
    });
  }

  /**
   * Index of the statement that runs at a time, -1 before the first.
   * Statements without duration share a start with the next one: the last of them is the one that runs.
   */
  at(t: number): number {
    let low = 0;
    let high = this.all.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.all[middle]?.start_s ?? Infinity) <= t + 1e-9) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /** Index of the execution of a line that a click on it names: the one after `current`, else the first. */
  next(line: number, current: number): number {
    const known = this.byLine.get(line) ?? [];
    return known.find((k) => k > current) ?? known[0] ?? -1;
  }

  /** How often a line was executed, and the seconds of all its executions. */
  total(line: number): { count: number; seconds: number } {
    const known = this.byLine.get(line) ?? [];
    return { count: known.length, seconds: known.reduce((sum, k) => sum + (this.all[k]?.duration_s ?? 0), 0) };
  }

  /** Indices of the statements that a range of time shows. */
  within(from: number, to: number): [number, number] {
    let first = Math.max(0, this.at(from));
    while (first > 0 && this.all[first - 1]?.start_s === this.all[first]?.start_s) first -= 1;
    return [first, this.at(to) + 1];
  }
}
