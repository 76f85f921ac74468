import { button, el, select } from "../dom";
import { seconds } from "../format";
import type { Player } from "../player";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10] as const;

/** Play, pause, speed, and a slider over the whole run. */
export class Transport {
  readonly element = el("div", { class: "transport", role: "group", "aria-label": "Playback" });
  private readonly player: Player;
  private readonly toggle: HTMLButtonElement;
  private readonly speed: HTMLSelectElement;
  private readonly slider = el("input", { type: "range", min: 0, step: 0.001, value: 0, "aria-label": "Time", "data-testid": "scrub" });
  private readonly clock = el("output", { class: "clock", "data-testid": "clock", "aria-live": "off" });
  private readonly whole: HTMLButtonElement;

  constructor(player: Player) {
    this.player = player;
    this.toggle = button("", "Play", () => this.switch(), { class: "play", "data-testid": "play" });
    const back = button("", "Statement before (Page up)", () => this.statement(-1), { class: "icon back" });
    const on = button("", "Next statement (Page down)", () => this.statement(1), { class: "icon next" });
    this.speed = select("Speed", SPEEDS.map((rate) => [rate, `${rate} ×`] as const), 1, (rate) => (player.rate = rate));
    this.whole = button("Whole run", "Show the whole run in timeline and charts (Z)", () => player.zoom(), { class: "whole", "data-testid": "whole" });
    // Beside the buttons that move the arm: these only show again what was.
    if (player.first.header.kind === "live") {
      this.element.setAttribute("aria-label", "Replay");
      this.element.append(el("b", { class: "called" }, "Replay"));
    }
    this.element.append(back, this.toggle, on, this.speed, this.slider, this.clock, this.whole);
    this.slider.addEventListener("input", () => player.seek(Number(this.slider.value)));
    player.on("time", () => this.paint());
    player.on("grown", () => this.paint());
    player.on("range", () => (this.whole.disabled = !player.zoomed));
    player.on("playing", () => this.playing());
    this.whole.disabled = true;
    this.paint();
    this.playing();
  }

  switch(): void {
    if (this.player.playing) this.player.pause();
    else this.player.play();
  }

  /** Go to the start of the statement before or after the running one. */
  statement(by: number): void {
    const next = Math.max(0, Math.min(this.player.first.statements.all.length - 1, this.player.statement + by));
    this.player.seekStatement(next);
  }

  faster(by: number): void {
    const at = SPEEDS.findIndex((rate) => rate === this.player.rate);
    const rate = SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, at + by))];
    if (rate === undefined) return;
    this.player.rate = rate;
    this.speed.value = String(rate);
  }

  paint(): void {
    const { t, end } = this.player;
    // Before the value, which a slider keeps inside its range; the end of a run that goes on moves with it.
    if (Number(this.slider.max) !== end) this.slider.max = String(end);
    this.slider.value = String(t);
    this.slider.setAttribute("aria-valuetext", seconds(t));
    this.clock.textContent = `${t.toFixed(3)} / ${seconds(end)}`;
  }

  private playing(): void {
    const name = this.player.playing ? "Pause" : "Play";
    this.toggle.setAttribute("aria-label", name);
    this.toggle.title = `${name} (Space)`;
    this.toggle.classList.toggle("on", this.player.playing);
  }
}
