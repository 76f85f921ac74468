import { button, el } from "../dom";

const KEYS: readonly (readonly [string, string])[] = [
  ["Space", "play or pause"],
  ["← →", "one cycle back or on; with Shift 0.1 s"],
  ["PgUp PgDn", "statement before, next statement"],
  ["Home End", "start, end"],
  ["+ −", "faster, slower"],
  ["Z", "whole run"],
  ["1 2 3 4", "view: 3-D, front, side, top"],
  ["E", "error of the path: true size, × 10, × 100, × 500"],
  ["L", "labels on or off"],
  ["P N J", "program, notes, joints"],
  ["T", "light or dark"],
  ["?", "this list"],
];

const HANDS: readonly (readonly [string, string])[] = [
  ["click a line", "go to its next execution"],
  ["click or drag in the timeline", "go to that time"],
  ["click in a chart", "go to that time"],
  ["drag in a chart", "zoom timeline and charts; double click: whole run"],
  ["click a name over a chart", "hide or show that curve"],
  ["drag the robot", "turn; right button: move; wheel: nearer, farther"],
];

/** The list of keys; Escape closes it. */
export class Help {
  readonly element = el("dialog", { class: "help", "aria-label": "Keys and mouse", "data-testid": "help" });
  readonly button: HTMLButtonElement;

  constructor() {
    const close = button("", "Close (Escape)", () => this.element.close(), { class: "icon close" });
    this.element.append(el("header", {}, el("h2", {}, "Keys and mouse"), close), list(KEYS, (keys) => keys.split(" ").map((key) => el("kbd", {}, key))), list(HANDS, (hand) => [hand]));
    this.element.addEventListener("click", (event) => {
      if (event.target === this.element) this.element.close();
    });
    this.button = button("?", "Keys and mouse (?)", () => this.toggle(), { class: "icon" });
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}

function list(rows: readonly (readonly [string, string])[], show: (name: string) => (Node | string)[]): HTMLElement {
  return el("dl", {}, ...rows.map(([name, text]) => el("div", {}, el("dt", {}, ...show(name)), el("dd", {}, text))));
}
