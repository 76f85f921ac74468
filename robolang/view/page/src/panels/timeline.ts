import type { Note, Statement } from "../contract";
import { el, token } from "../dom";
import { seconds } from "../format";
import type { Player } from "../player";
import type { Run } from "../run";

const LANE = 26;
const GAP = 4;
const AXIS = 18;
/** Height of the name of a run over its lane. */
const NAME = 18;
const PAPER_WIDTH = 700;
const INSTANT = 2;
/** More pins than these in sight are drawn without heads. */
const MOST_PINS = 24;
/** Statements without duration are caught this many pixels beside their mark. */
const REACH = 3;

type Kind = "move" | "hand" | "load" | "wait" | "other";
const KINDS: readonly (readonly [RegExp, Kind])[] = [
  [/^(MOVE|MOVEJ|MOVEC|SPLINE|APPROACH|DEPART)\b/, "move"],
  [/^HAND\b/, "hand"],
  [/^(LOAD|TOOL|FRAME)\b/, "load"],
  [/^(DELAY|WAIT|PAUSE)\b/, "wait"],
];

export function kindOf(text: string): Kind {
  return KINDS.find(([pattern]) => pattern.test(text))?.[1] ?? "other";
}

/** All statements of the runs over time; one lane for each run. */
export class Timeline {
  readonly element = el("div", { class: "timeline" });
  private readonly canvas = el("canvas", { "data-testid": "timeline", role: "img", "aria-label": "Statements over time" });
  private readonly head = el("div", { class: "playhead", "aria-hidden": "true" });
  private readonly player: Player;
  private width = 0;
  private paperWidth: number | null = null;
  private hovered = -1;
  private dragging = false;

  constructor(player: Player) {
    this.player = player;
    this.element.append(this.canvas, this.head);
    new ResizeObserver(() => this.draw()).observe(this.element);
    player.on("range", () => this.draw());
    player.on("grown", () => this.draw());
    player.on("time", () => this.paint());
    this.canvas.addEventListener("pointerdown", (event) => this.down(event));
    this.canvas.addEventListener("pointermove", (event) => this.move(event));
    this.canvas.addEventListener("pointerup", () => (this.dragging = false));
    this.canvas.addEventListener("pointercancel", () => (this.dragging = false));
    this.canvas.addEventListener("pointerleave", () => this.hover(-1));
    this.canvas.addEventListener("dblclick", () => player.zoom());
  }

  private get gap(): number {
    return this.player.runs.length > 1 ? NAME : GAP;
  }

  /** Move the playhead: no layout is read. */
  paint(): void {
    const x = this.x(this.player.t);
    this.head.style.transform = `translateX(${x.toFixed(1)}px)`;
    this.head.hidden = x < -1 || x > this.width + 1;
  }

  /** On paper the timeline is as wide as a sheet. */
  print(on: boolean): void {
    this.paperWidth = on ? PAPER_WIDTH : null;
    this.draw();
  }

  draw(): void {
    this.width = this.paperWidth ?? this.element.clientWidth;
    const { runs } = this.player;
    const height = runs.length * (LANE + this.gap) + AXIS;
    this.canvas.style.width = this.paperWidth ? `${this.paperWidth}px` : "";
    const scale = Math.min(devicePixelRatio, 2);
    this.canvas.style.height = `${height}px`;
    this.canvas.width = Math.round(this.width * scale);
    this.canvas.height = Math.round(height * scale);
    const pen = this.canvas.getContext("2d");
    if (!pen) return;
    pen.scale(scale, scale);
    pen.font = "11.5px ui-monospace, 'SF Mono', Menlo, Consolas, 'DejaVu Sans Mono', monospace";
    pen.textBaseline = "middle";
    runs.forEach((run, lane) => this.lane(pen, run, lane));
    this.axis(pen, height);
    this.paint();
  }

  private lane(pen: CanvasRenderingContext2D, run: Run, lane: number): void {
    const top = lane * (LANE + this.gap) + this.gap;
    if (this.player.runs.length > 1) {
      pen.fillStyle = token("--muted");
      pen.fillText(run.header.label, 0, top - NAME / 2);
    }
    const [first, last] = run.statements.within(...this.player.range);
    const instants: ((crowded: boolean) => void)[] = [];
    let drawn = -Infinity;
    let pinned = -Infinity;
    for (let k = first; k < last; k++) {
      const one = run.statements.all[k];
      if (!one) continue;
      const from = this.x(one.start_s);
      const to = this.x(one.start_s + one.duration_s);
      const lit = lane === 0 && k === this.hovered;
      const lasts = one.duration_s > 0;
      // Thousands of statements can share a pixel: one of them is enough.
      if (!lit && to < (lasts ? drawn : pinned) + 0.5) continue;
      if (lasts) {
        drawn = to;
        this.block(pen, one, from, to, top, lit);
      } else {
        pinned = to;
        instants.push((crowded) => this.instant(pen, one, from, top, lit, crowded));
      }
    }
    const crowded = instants.length > MOST_PINS;
    for (const draw of instants) draw(crowded);
    for (const note of run.notes) this.note(pen, note, top);
  }

  private block(pen: CanvasRenderingContext2D, one: Statement, from: number, to: number, top: number, lit: boolean): void {
    const kind = kindOf(one.text);
    const width = Math.max(1, to - from - 1);
    pen.fillStyle = token(lit ? `--${kind}-edge` : `--${kind}`);
    pen.beginPath();
    pen.roundRect(from, top, width, LANE, Math.min(3, width / 2));
    pen.fill();
    if (width > 3) {
      pen.fillStyle = token(`--${kind}-edge`);
      pen.fillRect(from, top + LANE - 2, width, 2);
    }
    if (width < 34) return;
    pen.save();
    pen.beginPath();
    pen.rect(from, top, width - 4, LANE);
    pen.clip();
    pen.fillStyle = token(lit ? "--panel" : "--ink");
    pen.fillText(one.text, Math.max(from, 0) + 7, top + LANE / 2);
    pen.restore();
  }

  /** A statement that takes no time: a pin in the block that begins there. */
  private instant(pen: CanvasRenderingContext2D, one: Statement, x: number, top: number, lit: boolean, crowded: boolean): void {
    pen.fillStyle = token(`--${kindOf(one.text)}-edge`);
    pen.globalAlpha = crowded && !lit ? 0.45 : 1;
    pen.beginPath();
    pen.rect(x - 1, top, lit ? INSTANT + 1 : INSTANT, LANE);
    if (lit || !crowded) pen.arc(x, top + LANE - 3, lit ? 4.5 : 3.5, 0, 2 * Math.PI);
    pen.fill();
    pen.globalAlpha = 1;
  }

  private note(pen: CanvasRenderingContext2D, note: Note, top: number): void {
    if (note.time_s === null || note.severity === "print") return;
    const x = this.x(note.time_s);
    if (x < -6 || x > this.width + 6) return;
    pen.fillStyle = token(`--${note.severity}`);
    pen.strokeStyle = token("--panel");
    pen.beginPath();
    pen.moveTo(x - 5, top - 3);
    pen.lineTo(x + 5, top - 3);
    pen.lineTo(x, top + 6);
    pen.closePath();
    pen.fill();
    pen.stroke();
  }

  private axis(pen: CanvasRenderingContext2D, height: number): void {
    const [from, to] = this.player.range;
    const step = niceStep((to - from) / Math.max(2, this.width / 110));
    pen.fillStyle = token("--muted");
    pen.textAlign = "center";
    const digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
    for (let k = Math.ceil(from / step); k * step <= to + 1e-9; k++) {
      const x = this.x(k * step);
      const text = `${(k * step).toFixed(digits)} s`;
      const half = pen.measureText(text).width / 2;
      pen.fillText(text, Math.max(half, Math.min(this.width - half, x)), height - AXIS / 2 + 2);
    }
    pen.textAlign = "start";
  }

  private x(t: number): number {
    const [from, to] = this.player.range;
    return ((t - from) / (to - from)) * this.width;
  }

  private time(event: PointerEvent): number {
    const [from, to] = this.player.range;
    return from + (event.offsetX / Math.max(1, this.width)) * (to - from);
  }

  /** Index of the statement of the first run that a place names. A mark without duration wins over the block it lies on. */
  private hit(event: PointerEvent): number {
    const { statements } = this.player.first;
    const t = this.time(event);
    const slack = (REACH / Math.max(1, this.width)) * (this.player.range[1] - this.player.range[0]);
    const [first, last] = statements.within(t - slack, t + slack);
    for (let k = last - 1; k >= first; k--) {
      const one = statements.all[k];
      if (one && one.duration_s <= 0 && Math.abs(one.start_s - t) <= slack) return k;
    }
    return statements.at(t);
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.dragging = true;
    this.canvas.setPointerCapture(event.pointerId);
    const index = this.hit(event);
    const one = this.player.first.statements.all[index];
    if (one && one.duration_s <= 0 && event.offsetY < LANE + 2 * this.gap) this.player.seekStatement(index);
    else this.player.seek(this.time(event));
  }

  private move(event: PointerEvent): void {
    if (this.dragging) this.player.seek(this.time(event));
    else this.hover(this.hit(event));
  }

  private hover(index: number): void {
    if (index === this.hovered) return;
    this.hovered = index;
    const one = this.player.first.statements.all[index];
    this.canvas.title = one ? `${named(one)}\n${seconds(one.start_s)}, takes ${seconds(one.duration_s)}` : "";
    this.draw();
  }
}

/** A statement as a person names it. */
export function named(one: Statement): string {
  const number = one.number === null ? "" : `${one.number}  `;
  return `${number}${one.text}`;
}

function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((k) => k * power >= least) ?? 10);
}
