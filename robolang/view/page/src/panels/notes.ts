import type { Note, Severity } from "../contract";
import { el } from "../dom";
import { seconds } from "../format";
import type { Player } from "../player";

const NAMES: Readonly<Record<Severity, string>> = { error: "Alarm", warning: "Warning", note: "Note", print: "Print" };

/** A list of more items than these is not read, and slows the page. */
const MOST_ITEMS = 2000;

/** Alarms, warnings, notes and printed lines in the order of their times. A click goes to the place. */
export class Notes {
  readonly element = el("div", { class: "notes", role: "group", "aria-label": "Alarms and notes", "data-testid": "notes" });
  private readonly player: Player;

  /** The lists that are shown. */
  private shown: readonly (readonly Note[])[] = [];

  constructor(player: Player) {
    this.player = player;
    player.on("grown", () => this.renew());
    this.renew();
  }

  /** Number of all notes. */
  get count(): number {
    return this.shown.reduce((sum, list) => sum + list.length, 0);
  }

  private renew(): void {
    const notes = this.player.runs.map((run) => run.notes);
    if (notes.every((list, k) => list === this.shown[k])) return;
    this.shown = notes;
    this.element.replaceChildren();
    this.player.runs.forEach((run, k) => {
      if (this.player.runs.length > 1) this.element.append(el("h3", {}, run.header.label));
      if (run.notes.length === 0) this.element.append(el("p", { class: "empty" }, "No alarm, no warning, no note."));
      else this.element.append(el("ol", {}, ...run.notes.slice(0, MOST_ITEMS).map((note) => this.item(note, k))));
      const left = run.notes.length - MOST_ITEMS;
      if (left > 0) this.element.append(el("p", { class: "empty" }, `${left} more are not listed.`));
    });
  }

  private item(note: Note, run: number): HTMLElement {
    const place = [note.line === null ? "" : `line ${note.line}`, note.time_s === null ? "" : seconds(note.time_s)].filter(Boolean).join(" · ");
    const head = el("span", { class: "about" }, el("span", { class: `flag ${note.severity}` }, note.code ?? NAMES[note.severity]), el("span", { class: "place" }, place));
    const body = el("span", { class: "text" }, note.text);
    if (note.time_s === null) return el("li", { class: "item" }, head, body);
    const time = note.time_s;
    const made = el("button", { type: "button", class: "item", "data-testid": "note" }, head, body);
    made.addEventListener("click", () => this.go(note, time, run));
    return el("li", {}, made);
  }

  private go(note: Note, time: number, run: number): void {
    const { statements } = this.player.first;
    const running = statements.at(time);
    const known = run === 0 && note.line !== null ? (statements.byLine.get(note.line) ?? []) : [];
    // The note names its line; at one time several statements can start.
    const meant = known.find((k) => statements.all[k]?.start_s === statements.all[running]?.start_s);
    this.player.seek(time, meant);
    this.player.reveal(time);
  }
}
