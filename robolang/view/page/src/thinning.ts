/** Points of a curve for a plot: times and values, at most two for each bin. */
export interface Points {
  readonly t: Float64Array;
  readonly y: (number | null)[];
}

/**
 * Least and largest value of each of `bins` bins of the rows [from, to), in the order in which they occur.
 * A bin without any value gives null: a gap. Few rows are returned as they are.
 */
export function thin(values: Float32Array, from: number, to: number, bins: number, time: (row: number) => number): Points {
  const rows = to - from;
  if (rows <= 3 * bins) {
    const t = Float64Array.from({ length: rows }, (_, k) => time(from + k));
    return { t, y: Array.from({ length: rows }, (_, k) => orGap(values[from + k])) };
  }
  const t = new Float64Array(2 * bins);
  const y: (number | null)[] = new Array<number | null>(2 * bins);
  for (let bin = 0; bin < bins; bin++) {
    const a = from + Math.floor((rows * bin) / bins);
    const b = from + Math.floor((rows * (bin + 1)) / bins);
    const [low, high] = extremes(values, a, b);
    const [first, second] = low <= high ? [low, high] : [high, low];
    t[2 * bin] = time(a);
    t[2 * bin + 1] = time((a + b) >> 1);
    y[2 * bin] = first < 0 ? null : orGap(values[first]);
    y[2 * bin + 1] = second < 0 ? null : orGap(values[second]);
  }
  return { t, y };
}

/** Rows of the least and the largest value in [a, b); -1 where there is no value. */
function extremes(values: Float32Array, a: number, b: number): [number, number] {
  let low = -1;
  let high = -1;
  let least = Infinity;
  let most = -Infinity;
  for (let k = a; k < b; k++) {
    const value = values[k] ?? NaN;
    if (value < least) {
      least = value;
      low = k;
    }
    if (value > most) {
      most = value;
      high = k;
    }
  }
  return [low, high];
}

function orGap(value: number | undefined): number | null {
  return value === undefined || Number.isNaN(value) ? null : value;
}
