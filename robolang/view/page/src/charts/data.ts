import uPlot from "uplot";
import type { Role, SeriesHead } from "../contract";
import type { Curve, Run, Signal } from "../run";
import { thin } from "../thinning";

/** One line of a chart: a series of one of the runs. */
export interface Line {
  readonly head: SeriesHead;
  /** Number of the run, from 0; the second run is dashed. */
  readonly run: number;
  /** Number of the colour; the same for a value and its command. */
  readonly colour: number;
  readonly curve: Curve;
}

/** Lines of a chart in the order of its series, first those of the first run. */
export function linesOf(series: readonly SeriesHead[], runs: readonly Run[]): readonly Line[] {
  const colours = coloursOf(series);
  return runs.flatMap((run, k) =>
    series.flatMap((head, j) => {
      const curve = run.curve(head);
      return curve ? [{ head, run: k, colour: colours[j] ?? 0, curve }] : [];
    }),
  );
}

/** Whether a series belongs to another one: the command of a value, the limit of a value. */
export const follows = (role: Role): boolean => role === "command" || role === "limit";

/** Number of the series that a series belongs to: a command or a limit to the value of the same column, others to none. */
export function leaderOf(series: readonly SeriesHead[], j: number): number {
  const head = series[j];
  if (!head || !follows(head.role)) return j;
  const leader = series.findIndex((other) => !follows(other.role) && other.column === head.column);
  return leader >= 0 ? leader : j;
}

/** A value has a colour of its own, what belongs to it has the same. */
export function coloursOf(series: readonly SeriesHead[]): number[] {
  const own = series.flatMap((head, j) => (follows(head.role) ? [] : [j]));
  return series.map((_, j) => Math.max(0, own.indexOf(leaderOf(series, j))));
}

/** Data of a plot: the rows of the range [from, to] s, at most two for each of `bins` bins. */
export function plotData(lines: readonly Line[], from: number, to: number, bins: number, place: (y: number, line: number) => number): uPlot.AlignedData {
  const tables = new Map<string, { t: Float64Array; ys: (number | null)[][] }>();
  const order: [string, number][] = [];
  lines.forEach((line, k) => {
    const { signal, values } = line.curve;
    const [first, last] = rows(signal, from, to);
    const points = thin(values, first, last, bins, (row) => signal.t0 + row * signal.dt);
    const key = `${signal.t0} ${signal.dt} ${first} ${last}`;
    const table = tables.get(key) ?? { t: points.t, ys: [] };
    tables.set(key, table);
    order.push([key, table.ys.length]);
    table.ys.push(points.y.map((y) => (y === null ? null : place(y, k))));
  });
  return joined([...tables.values()], [...tables.keys()], order);
}

/** Tables with different times become one: where a line has no row of its own, it goes on undisturbed. */
function joined(tables: readonly { t: Float64Array; ys: (number | null)[][] }[], keys: readonly string[], order: readonly [string, number][]): uPlot.AlignedData {
  const [only] = tables;
  if (!only) return [[]];
  if (tables.length === 1) return [only.t, ...only.ys];
  const all = uPlot.join(tables.map((table) => [table.t, ...table.ys] as uPlot.AlignedData));
  const starts: number[] = [];
  tables.reduce((sum, table, k) => ((starts[k] = sum), sum + table.ys.length), 1);
  const columns = order.map(([key, k]) => all[(starts[keys.indexOf(key)] ?? 1) + k] ?? []);
  return [all[0], ...columns] as uPlot.AlignedData;
}

function rows(signal: Signal, from: number, to: number): [number, number] {
  const first = Math.max(0, Math.floor((from - signal.t0) / signal.dt) - 1);
  const last = Math.min(signal.rows, Math.ceil((to - signal.t0) / signal.dt) + 2);
  return [Math.min(first, last), last];
}
