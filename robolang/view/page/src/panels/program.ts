import type { Note, Severity } from "../contract";
import { el } from "../dom";
import { seconds } from "../format";
import type { Player } from "../player";

/** Above this many lines only those on the screen are elements of the page. */
export const MOST_ROWS = 5000;
const SPARE_ROWS = 20;
const RANK: readonly Severity[] = ["error", "warning", "note", "print"];

/** The text of the program with the times of its lines; the running line is marked. */
export class ProgramText {
  readonly element = el("div", { class: "program", role: "group", "aria-label": "Program text", "data-testid": "program" });
  private readonly list = el("div", { class: "lines" });
  private readonly player: Player;
  private readonly lines: readonly string[];
  private readonly notes = new Map<number, Note[]>();
  /** The list that `notes` sorts by lines. */
  private noted: readonly Note[] = [];
  private readonly rows = new Map<number, HTMLElement>();
  private readonly rowHeight = 22;
  private height = 0;
  private current = 0;
  private other = 0;
  /** The line that the Tab key enters. */
  private entry = 0;
  private whole: boolean;
  /** Seconds of the line that took longest: the scale of the bars. */
  private longest = 0;

  constructor(player: Player, text: string) {
    this.player = player;
    this.lines = text.replace(/\r?\n$/, "").split(/\r?\n/);
    this.whole = this.lines.length <= MOST_ROWS;
    this.sortNotes();
    this.measure();
    this.element.append(this.list);
    this.element.addEventListener("scroll", () => this.window());
    this.element.addEventListener("keydown", (event) => this.key(event));
    this.list.addEventListener("click", (event) => this.press(event.target));
    new ResizeObserver(() => {
      this.height = this.element.clientHeight;
      this.window();
    }).observe(this.element);
    this.window();
    player.on("time", () => this.paint());
    player.on("grown", () => this.renew());
  }

  /** For paper: every line, or the window again. */
  print(on: boolean): void {
    this.whole = on || this.lines.length <= MOST_ROWS;
    this.window();
  }

  /** Mark the running line; called for every time, and does something only where the line changed. */
  paint(): void {
    const { runs, statement, t, first } = this.player;
    const second = runs[1];
    const other = second ? (second.statements.all[second.statements.at(t)]?.line ?? 0) : 0;
    const current = first.statements.all[statement]?.line ?? 0;
    if (current === this.current && other === this.other) return;
    const moved = current !== this.current;
    this.mark(false);
    this.current = current;
    this.other = other;
    if (moved) this.scrollTo(current);
    this.mark(true);
  }

  private mark(on: boolean): void {
    const row = this.rows.get(this.current);
    row?.classList.toggle("now", on);
    if (on) row?.setAttribute("aria-current", "true");
    else row?.removeAttribute("aria-current");
    this.rows.get(this.other)?.classList.toggle("other", on);
  }

  private measure(): void {
    const { statements } = this.player.first;
    this.longest = [...statements.byLine.keys()].reduce((most, line) => Math.max(most, statements.total(line).seconds), 1e-9);
    this.entry = [...statements.byLine.keys()].reduce((least, line) => Math.min(least, line), this.lines.length);
  }

  /** A run that still goes on has executed more: the rows of its lines are made anew, but for one that is in use. */
  private renew(): void {
    this.measure();
    for (const line of new Set([...this.sortNotes(), ...this.player.first.statements.byLine.keys()])) {
      const old = this.rows.get(line);
      if (!old || old === document.activeElement) continue;
      const made = this.row(line);
      made.classList.toggle("due", old.classList.contains("due"));
      old.replaceWith(made);
      this.rows.set(line, made);
    }
    this.mark(true);
  }

  /** Make the rows that the panel shows. */
  private window(): void {
    const count = this.lines.length;
    let [from, to] = [1, count + 1];
    if (!this.whole) {
      const top = Math.floor(this.element.scrollTop / this.rowHeight);
      from = Math.max(1, top + 1 - SPARE_ROWS);
      to = Math.min(count + 1, top + 1 + Math.ceil(this.height / this.rowHeight) + SPARE_ROWS);
    }
    if (this.rows.size === to - from && this.rows.has(from)) return;
    const focused = Number((document.activeElement as HTMLElement | null)?.dataset.line ?? 0);
    this.rows.clear();
    const made: HTMLElement[] = [];
    for (let line = from; line < to; line++) {
      const row = this.row(line);
      this.rows.set(line, row);
      made.push(row);
    }
    this.list.replaceChildren(...made);
    this.list.style.paddingTop = `${(from - 1) * this.rowHeight}px`;
    this.list.style.paddingBottom = `${(count + 1 - to) * this.rowHeight}px`;
    this.mark(true);
    if (focused) this.rows.get(focused)?.focus({ preventScroll: true });
  }

  private row(line: number): HTMLElement {
    const text = this.lines[line - 1] ?? "";
    const { count, seconds: spent } = this.player.first.statements.total(line);
    const row = el("div", { class: "line", "data-testid": "line", "data-line": line, title: text.length > 30 ? text.trim() : undefined });
    row.append(el("span", { class: "number", "aria-hidden": "true" }, String(line)), source(text));
    const side = el("span", { class: "side" });
    row.append(side);
    const note = this.worst(line);
    if (note) {
      row.classList.add(`has-${note.severity}`);
      side.append(el("span", { class: `flag ${note.severity}`, title: note.text }, note.code ?? note.severity));
    }
    if (count === 0) return row;
    row.classList.add("ran");
    row.setAttribute("role", "button");
    row.tabIndex = line === this.entry ? 0 : -1;
    if (count > 1) side.append(el("span", { class: "count", title: `executed ${count} times` }, `${count} ×`));
    if (spent > 0) {
      const share = el("span", { class: "share", "aria-hidden": "true" });
      share.style.width = `${((100 * spent) / this.longest).toFixed(1)}%`;
      side.append(el("span", { class: "spent" }, seconds(spent, 2), share));
    }
    return row;
  }

  /** Sort the notes by their lines; returns the lines that had one or have one now, none where the list is the same. */
  private sortNotes(): readonly number[] {
    const { notes } = this.player.first;
    if (notes === this.noted) return [];
    this.noted = notes;
    const before = [...this.notes.keys()];
    this.notes.clear();
    for (const note of notes) if (note.line !== null) this.notes.set(note.line, [...(this.notes.get(note.line) ?? []), note]);
    return [...before, ...this.notes.keys()];
  }

  private worst(line: number): Note | undefined {
    const known = this.notes.get(line);
    return known && [...known].sort((a, b) => RANK.indexOf(a.severity) - RANK.indexOf(b.severity))[0];
  }

  private press(target: EventTarget | null): void {
    const row = (target as HTMLElement | null)?.closest<HTMLElement>(".line");
    if (!row) return;
    const line = Number(row.dataset.line);
    const index = this.player.first.statements.next(line, this.player.statement);
    if (index < 0) return;
    this.enter(line);
    this.player.seekStatement(index);
  }

  private key(event: KeyboardEvent): void {
    const row = (event.target as HTMLElement).closest<HTMLElement>(".line");
    if (!row) return;
    if (event.key === "Enter" || event.key === " ") this.press(row);
    else if (event.key === "ArrowDown" || event.key === "ArrowUp") this.step(Number(row.dataset.line), event.key === "ArrowDown" ? 1 : -1);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Move the focus to the nearest line that was executed. */
  private step(from: number, by: number): void {
    for (let line = from + by; line >= 1 && line <= this.lines.length; line += by) {
      if (!this.player.first.statements.byLine.has(line)) continue;
      this.scrollTo(line);
      this.enter(line);
      this.rows.get(line)?.focus({ preventScroll: true });
      return;
    }
  }

  private enter(line: number): void {
    this.rows.get(this.entry)?.setAttribute("tabindex", "-1");
    this.entry = line;
    this.rows.get(line)?.setAttribute("tabindex", "0");
  }

  private scrollTo(line: number): void {
    const top = (line - 1) * this.rowHeight;
    const shown = this.element.scrollTop;
    // The first line is marked before the panel has been measured.
    this.height ||= this.element.clientHeight;
    if (top < shown || top > shown + this.height - 2 * this.rowHeight) this.element.scrollTop = top - this.height / 2;
    this.window();
  }
}

/** One line of text: its number, its first word and its comment have their own looks. */
function source(text: string): HTMLElement {
  const made = el("code", { class: "source" });
  const [, number = "", word = "", rest = ""] = /^(\s*\d*\s*)([A-Za-z]*)(.*)$/.exec(text) ?? [];
  const comment = commentAt(rest);
  if (number) made.append(el("span", { class: "stated" }, number));
  if (/^rem$/i.test(word)) return appended(made, el("span", { class: "comment" }, word + rest));
  if (word) made.append(el("b", {}, word));
  made.append(rest.slice(0, comment));
  if (comment < rest.length) made.append(el("span", { class: "comment" }, rest.slice(comment)));
  return made;
}

function appended(parent: HTMLElement, child: Node): HTMLElement {
  parent.append(child);
  return parent;
}

/** Where the comment of a line begins; an apostrophe inside of a text does not begin one. */
function commentAt(text: string): number {
  let quoted = false;
  for (let k = 0; k < text.length; k++) {
    if (text[k] === '"') quoted = !quoted;
    else if (text[k] === "'" && !quoted) return k;
  }
  return text.length;
}
