import uPlot from "uplot";
import type { ChartHead, SeriesHead } from "../contract";
import { el, token } from "../dom";
import { fixed } from "../format";
import type { Player } from "../player";
import type { Curve } from "../run";
import { coloursOf, follows, leaderOf, type Line, linesOf, plotData } from "./data";
import { drawBand, drawNames, drawNotes, NAME_LETTERS } from "./drawing";

const HEIGHT = 136;
const LANE = 20;
const COLOURS = 8;
/** Digits after the point that a unit is worth: always so many, so that nothing moves when the values change. */
const DIGITS: Readonly<Record<string, number>> = { deg: 2, mm: 3, mdeg: 1, "µm": 1, "mm/s": 1, "deg/s": 1, "% of limit": 1, "N m": 2, N: 1, kg: 2, ms: 1 };
/** Width of a digit and of a letter over a chart, of what stands around them, and the most that a name gets, px. */
const DIGIT = 6.6;
const LETTER = 7;
const AROUND = 26;
const MOST_NAME = 110;
/** Playing, the values over a chart change this often at most: no eye reads faster. */
const VALUE_MS = 120;
/** A click within this time after a drag belongs to the drag. */
const AFTER_DRAG_MS = 120;

/** One chart: drawn when it is first seen, never while the run plays; its playhead is an element above it. */
export class Chart {
  readonly element: HTMLElement;
  readonly head: ChartHead;
  visible = false;
  private readonly player: Player;
  private readonly box: HTMLElement;
  private readonly list: HTMLElement;
  private readonly playhead = el("div", { class: "playhead", "aria-hidden": "true" });
  /** Where the value of each series is written. */
  private readonly values = new Map<SeriesHead, HTMLElement>();
  private readonly hidden = new Set<number>();
  private lines: readonly Line[] | null = null;
  /** The chart has nothing but steps between whole numbers: modes, counts. */
  private whole = false;
  private plot: uPlot | null = null;
  private width = 0;
  /** Letters of the longest value so far. */
  private letters = 0;
  private paperWidth: number | null = null;
  private stale = true;
  private dragged = -Infinity;
  private valued = -Infinity;

  constructor(player: Player, head: ChartHead) {
    this.player = player;
    this.head = head;
    this.box = el("div", { class: "plot" });
    this.box.style.height = `${this.height}px`;
    const values = (this.list = el("div", { class: "values", role: "group", "aria-label": `Curves of ${head.title}` }));
    const title = el("h3", { id: `chart-${head.id}` }, head.title, el("span", { class: "unit" }, [head.unit, player.first.header.kind === "live" ? "sampled" : ""].filter(Boolean).join(", ")));
    this.element = el("section", { class: "chart", "data-testid": "chart", "data-signal": head.id, "aria-labelledby": `chart-${head.id}` }, el("header", {}, title, values), this.box);
    const colours = coloursOf(head.series);
    head.series.forEach((series, k) => {
      if (!follows(series.role)) values.append(this.chip(series, colours[k] ?? 0, k));
    });
    this.element.classList.toggle("single", this.values.size === 1);
    for (const role of ["command", "limit"] as const) if (head.series.some((series) => series.role === role)) title.after(legendKey(role));
    new ResizeObserver(() => this.resize()).observe(this.box);
  }

  private get available(): number {
    return this.paperWidth ?? this.box.clientWidth;
  }

  private get height(): number {
    return this.head.lanes ? 36 + LANE * Math.max(2, this.head.series.length) : HEIGHT;
  }

  /** Bring the drawing up to date: the first time, for a new range, or in another theme. */
  draw(): void {
    if (!this.stale || this.available === 0) return;
    this.stale = false;
    const [from, to] = this.player.range;
    if (!this.plot) this.build();
    const plot = this.plot;
    if (!plot) return;
    plot.batch(() => {
      plot.setData(this.data(), false);
      plot.setScale("x", { min: from, max: to });
    });
    this.place();
  }

  /** Draw in a given width, or in that of its place again. */
  print(width: number | null): void {
    this.paperWidth = width;
    this.stale = true;
    this.draw();
    this.resize();
  }

  /** The drawing no longer holds. */
  spoil(how: "range" | "theme" | "rows"): void {
    this.stale = true;
    if (how === "rows") this.lines = null;
    if (how === "theme") {
      this.plot?.destroy();
      this.plot = null;
    }
    if (this.visible) this.draw();
  }

  /** Show the time: moves the playhead, and writes the values. */
  paint(now: number): void {
    if (!this.plot) return;
    this.place();
    if (this.player.playing && now - this.valued < VALUE_MS) return;
    this.valued = now;
    for (const [series, value] of this.values) value.textContent = this.valueText(series);
  }

  private laidOut(plot: uPlot): void {
    this.width = plot.bbox.width / uPlot.pxRatio;
    const { min, max } = plot.scales.y ?? {};
    this.letters = Math.max(this.letters, ...[min ?? 0, max ?? 0].map((y) => fixed(y, this.digits).length));
    this.list.style.setProperty("--columns", String(this.columns));
    this.paint(Infinity);
  }

  /** Values in one row: as many as have room for their names and digits, in rows of nearly one length. */
  private get columns(): number {
    const count = this.values.size;
    const name = Math.max(...[...this.values.keys()].map((series) => LETTER * series.label.length));
    const texts = this.player.runs.length * (this.curves().some(({ curve }) => curve.signal.paired) ? 2 : 1);
    const width = AROUND + Math.min(MOST_NAME, name) + DIGIT * (texts * (this.letters + 3) - 3);
    const fits = Math.max(1, Math.floor(this.available / width));
    return Math.ceil(count / Math.ceil(count / fits));
  }

  private place(): void {
    const [from, to] = this.player.range;
    const x = ((this.player.t - from) / (to - from)) * this.width;
    this.playhead.style.transform = `translateX(${x.toFixed(1)}px)`;
    this.playhead.hidden = x < -1 || x > this.width + 1;
  }

  /** The values of a series at the time, one for each run. */
  private valueText(series: SeriesHead): string {
    const lines = this.curves().filter((line) => line.head === series);
    const texts = lines.map(({ curve }) => valueText(curve, this.player.t, this.digits));
    return texts.join(" | ") || "–";
  }

  private get digits(): number {
    if (this.head.lanes || this.whole) return 0;
    return DIGITS[this.head.unit] ?? 3;
  }

  private curves(): readonly Line[] {
    if (!this.lines) {
      this.lines = linesOf(this.head.series, this.player.runs);
      this.whole = this.lines.every(({ head, curve }) => head.role === "step" && curve.values.every(Number.isInteger));
    }
    return this.lines;
  }

  private chip(series: SeriesHead, colour: number, index: number): HTMLElement {
    const value = el("output", { "aria-live": "off" }, "–");
    this.values.set(series, value);
    const key = el("i", { class: `key colour-${colour % COLOURS} ${series.role}`, "aria-hidden": "true" });
    const made = el("button", { type: "button", class: "chip", "aria-pressed": "true", title: `Hide or show ${series.label}` }, key, el("span", { class: "name" }, series.label), value);
    made.addEventListener("click", () => this.toggle(made, index));
    return made;
  }

  /** Hide or show a series, and what follows it: its command, its limits. */
  private toggle(chip: HTMLElement, index: number): void {
    const show = chip.getAttribute("aria-pressed") !== "true";
    chip.setAttribute("aria-pressed", String(show));
    this.curves().forEach((line, k) => {
      if (leaderOf(this.head.series, this.head.series.indexOf(line.head)) !== index) return;
      if (show) this.hidden.delete(k);
      else this.hidden.add(k);
      this.plot?.setSeries(k + 1, { show });
    });
  }

  private data(): uPlot.AlignedData {
    const [from, to] = this.player.range;
    const bins = Math.max(200, this.width || this.available);
    const lanes = this.head.lanes ?? false;
    const count = this.head.series.length;
    const lines = this.curves();
    // A level is drawn in seven tenths of its lane; a number that an input holds is a level of its largest value.
    const heights = lanes ? lines.map(({ curve }) => 0.7 / curve.values.reduce((most, y) => Math.max(most, Math.abs(y) || 0), 1)) : [];
    return plotData(lines, from, to, bins, (y, k) => (lanes ? count - 1 - this.lane(lines[k]) + (heights[k] ?? 0) * y : y));
  }

  private lane(line: Line | undefined): number {
    return line ? this.head.series.indexOf(line.head) : 0;
  }

  private build(): void {
    const plot = new uPlot(this.options(), this.data(), this.box);
    this.plot = plot;
    plot.over.append(this.playhead);
    plot.over.addEventListener("click", (event) => {
      if (performance.now() - this.dragged > AFTER_DRAG_MS) this.player.seek(plot.posToVal(event.offsetX, "x"));
    });
    plot.over.addEventListener("dblclick", () => this.player.zoom());
    this.paint(Infinity);
  }

  private options(): uPlot.Options {
    const axis: uPlot.Axis = {
      stroke: token("--muted"),
      font: "11px system-ui, sans-serif",
      grid: { stroke: token("--grid"), width: 1 },
      ticks: { show: false },
    };
    const lanes = this.head.lanes ?? false;
    const names = this.head.series.map((series) => series.label);
    const letters = Math.max(...names.map((name) => name.length));
    const upright: uPlot.Axis = lanes
      ? { ...axis, size: Math.min(150, 14 + 6.5 * letters), splits: names.map((_, k) => k + 0.35), values: () => [...names].reverse() }
      : { ...axis, size: 50, gap: 4, space: 26, values: (_, ticks, __, ___, step) => ticks.map((y) => fixed(y, digitsOf(step))), ...(this.whole ? { incrs: [1, 2, 5, 10, 100] } : {}) };
    return {
      width: this.available,
      height: this.height,
      padding: [8, this.values.size > 1 && !lanes ? 10 + 7 * Math.min(letters, NAME_LETTERS) : 12, 0, 0],
      legend: { show: false },
      scales: { x: { time: false }, y: { range: (_, low, high) => this.yRange(low, high) } },
      axes: [{ ...axis, size: 24, gap: 4, space: 64, values: (_, ticks) => ticks.map((tick) => `${+tick.toFixed(6)} s`) }, upright],
      series: [{}, ...this.curves().map((line, k) => this.series(line, k))],
      cursor: {
        y: false,
        points: { show: false },
        drag: { x: true, y: false, setScale: false },
        sync: { key: "run", setSeries: false, filters: { pub: passes, sub: passes } },
      },
      hooks: {
        setSelect: [(plot) => this.selected(plot)],
        // The plot lays itself out after its constructor has returned.
        drawClear: [(plot) => this.laidOut(plot), (plot) => drawBand(plot, this.head.band)],
        draw: [
          (plot) => drawNotes(plot, this.player.first.notes),
          (plot) => drawNames(plot, lanes ? [] : this.curves(), this.hidden),
        ],
      },
    };
  }

  private series(line: Line, k: number): uPlot.Series {
    const stepped = line.head.role === "step" || this.head.lanes;
    const made: uPlot.Series = {
      label: line.head.label,
      show: !this.hidden.has(k),
      stroke: token(line.head.role === "limit" ? "--limit" : `--curve-${line.colour % COLOURS}`),
      width: line.run > 0 || line.head.role === "command" ? 1.1 : 1.6,
      points: { show: false, size: 4, filter: (plot, k) => isolated(plot.data[k] ?? []) },
    };
    const dash = dashOf(line);
    if (dash) made.dash = dash;
    const paths = stepped ? uPlot.paths.stepped?.({ align: 1 }) : undefined;
    if (paths) made.paths = paths;
    return made;
  }

  /** Range of the values, with the limits where the values come near to them. */
  private yRange(low: number | null, high: number | null): [number, number] {
    if (this.head.lanes) return [-0.15, this.head.series.length - 0.1];
    if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
    const [under, over] = this.head.band ?? [NaN, NaN];
    if (low < 0.6 * under) low = Math.min(low, under);
    if (high > 0.6 * over) high = Math.max(high, over);
    // Noise in the last digits of a constant is not worth an axis of its own, nor is less than a value shows.
    const least = Math.max(2e-3 * Math.max(Math.abs(low), Math.abs(high)), this.whole ? 0.05 : 2.5 * 10 ** -this.digits);
    const margin = Math.max(0.06 * (high - low), least);
    return [low >= 0 && low - margin < 0 ? Math.min(0, low) : low - margin, high + margin];
  }

  private selected(plot: uPlot): void {
    const { left, width } = plot.select;
    if (!(width > 3)) return;
    this.dragged = performance.now();
    const [from, to] = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.player.zoom(from, to);
  }

  private resize(): void {
    if (!this.plot || this.available === 0) return;
    this.plot.setSize({ width: this.available, height: this.height });
    this.spoil("range");
  }
}

/** The value at a time; of a bin its least and its largest value, since it does not say which of them was when. */
function valueText(curve: Curve, t: number, digits: number): string {
  if (!curve.signal.covers(t)) return fixed(NaN, digits);
  const [least, most] = curve.signal.range((row) => curve.value(row), t).map((value) => fixed(value, digits));
  return least === most ? (least ?? "") : `${least} .. ${most}`;
}

/** Indices of values without a neighbour: no line shows them. What is undefined is a row of another line, and no gap. */
function isolated(values: ArrayLike<number | null | undefined>): number[] {
  const own = Array.from({ length: values.length }, (_, k) => k).filter((k) => values[k] !== undefined);
  const empty = (j: number): boolean => values[own[j] ?? -1] == null;
  return own.filter((_, j) => !empty(j) && empty(j - 1) && empty(j + 1));
}

/** Digits after the point that the marks of an axis need to differ. */
function digitsOf(step: number): number {
  let digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  // A quarter has a digit more than a tenth.
  while (digits < 9 && Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits)) > 1e-6) digits += 1;
  return digits;
}

/** What the dotted or dashed lines of a chart are. */
function legendKey(role: "command" | "limit"): HTMLElement {
  return el("span", { class: "legend-key" }, el("i", { class: `key ${role}`, "aria-hidden": "true" }), role);
}

/** Mouse-up must not pass from chart to chart: a drag in one would zoom as often as there are charts. */
const passes = (type: string): boolean => type === "mousemove" || type === "mouseleave";

/** The second run is dashed, commands are dotted, limits have long dashes. */
function dashOf(line: Line): number[] | null {
  if (line.head.role === "limit") return [8, 5];
  if (line.run > 0) return [5, 4];
  return line.head.role === "command" ? [1.5, 2.5] : null;
}
