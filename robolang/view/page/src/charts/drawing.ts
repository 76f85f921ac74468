import type uPlot from "uplot";
import type { Note } from "../contract";
import { token } from "../dom";
import type { Line } from "./data";

const NAME_HEIGHT = 11;
/** Where more notes are shown than these, only alarms have a line through the plot. */
const MOST_LINES = 12;
/** So many letters of a name fit beside a plot. */
export const NAME_LETTERS = 6;

/** The regions beyond the limits, drawn under the curves. */
export function drawBand(plot: uPlot, band: readonly [number, number] | null): void {
  if (!band) return;
  const { ctx, bbox } = plot;
  const clamp = (y: number): number => Math.max(bbox.top, Math.min(bbox.top + bbox.height, y));
  const [low, high] = [clamp(plot.valToPos(band[0], "y", true)), clamp(plot.valToPos(band[1], "y", true))];
  ctx.save();
  ctx.fillStyle = token("--beyond");
  ctx.fillRect(bbox.left, bbox.top, bbox.width, high - bbox.top);
  ctx.fillRect(bbox.left, low, bbox.width, bbox.top + bbox.height - low);
  ctx.strokeStyle = token("--limit");
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([8 * devicePixelRatio, 5 * devicePixelRatio]);
  for (const y of [low, high]) {
    if (y <= bbox.top || y >= bbox.top + bbox.height) continue;
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
  }
  ctx.restore();
}

/** Alarms, warnings and notes as small marks at the upper edge, at their times. */
export function drawNotes(plot: uPlot, notes: readonly Note[]): void {
  const { ctx, bbox } = plot;
  const size = 4 * devicePixelRatio;
  ctx.save();
  ctx.setLineDash([]);
  ctx.lineWidth = devicePixelRatio;
  const placed = notes.flatMap((note) => {
    if (note.time_s === null || note.severity === "print") return [];
    const x = plot.valToPos(note.time_s, "x", true);
    return x < bbox.left || x > bbox.left + bbox.width ? [] : [{ note, x }];
  });
  for (const { note, x } of placed) {
    ctx.fillStyle = token(`--${note.severity}`);
    if (placed.length <= MOST_LINES || note.severity === "error") {
      ctx.strokeStyle = ctx.fillStyle;
      ctx.globalAlpha = 0.35;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      ctx.globalAlpha = 1;
    }
    ctx.beginPath();
    ctx.moveTo(x - size, bbox.top);
    ctx.lineTo(x + size, bbox.top);
    ctx.lineTo(x, bbox.top + 1.5 * size);
    ctx.fill();
  }
  ctx.restore();
}

/** The name of each curve at its right end, moved apart where they would overlap: colour is not the only cue. */
export function drawNames(plot: uPlot, lines: readonly Line[], hidden: ReadonlySet<number>): void {
  const shown = lines.flatMap((line, k) => {
    if (line.run > 0 || hidden.has(k) || line.head.role === "command" || line.head.role === "limit") return [];
    const value = last(plot.data[k + 1] ?? []);
    return value === null ? [] : [{ line, y: plot.valToPos(value, "y", true) }];
  });
  if (shown.length < 2) return;
  const { ctx, bbox } = plot;
  const gap = NAME_HEIGHT * devicePixelRatio;
  const ys = apart(shown.map(({ y }) => y), gap, bbox.top + gap / 2, bbox.top + bbox.height);
  ctx.save();
  ctx.font = `${10.5 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textBaseline = "middle";
  ctx.textAlign = "left";
  shown.forEach(({ line }, k) => {
    ctx.fillStyle = token(`--curve-${line.colour % 8}`);
    ctx.fillText(line.head.label.slice(0, NAME_LETTERS), bbox.left + bbox.width + 5 * devicePixelRatio, ys[k] ?? 0);
  });
  ctx.restore();
}

function last(values: ArrayLike<number | null | undefined>): number | null {
  for (let k = values.length - 1; k >= 0; k--) {
    const value = values[k];
    if (value !== null && value !== undefined) return value;
  }
  return null;
}

/** Places near the given ones, in the same order, at least `gap` apart and inside [top, bottom] where they fit. */
export function apart(places: readonly number[], gap: number, top: number, bottom: number): number[] {
  const order = places.map((_, k) => k).sort((a, b) => (places[a] ?? 0) - (places[b] ?? 0));
  const out = [...places];
  let least = top;
  for (const k of order) {
    out[k] = Math.max(out[k] ?? 0, least);
    least = (out[k] ?? 0) + gap;
  }
  let most = bottom;
  for (const k of [...order].reverse()) {
    out[k] = Math.min(out[k] ?? 0, most);
    most = (out[k] ?? 0) - gap;
  }
  return out;
}
