import type { JointHead } from "../contract";
import { button, el } from "../dom";
import { number, seconds } from "../format";
import type { Player } from "../player";

const FACTOR: Readonly<Record<string, number>> = { deg: 180 / Math.PI, mm: 1000 };

interface Row {
  readonly head: JointHead;
  readonly mark: HTMLElement;
  readonly value: HTMLElement;
}

/** Each joint between its limits: where it is now, and its least distance from a limit. */
export class Joints {
  readonly element = el("div", { class: "joints", role: "group", "aria-label": "Joint limits and margins", "data-testid": "joints" });
  private readonly player: Player;
  private readonly rows: Row[] = [];

  constructor(player: Player) {
    this.player = player;
    for (const head of player.first.header.joints) this.element.append(this.row(head));
    if (this.rows.length === 0) this.element.append(el("p", { class: "empty" }, "The run names no joints."));
  }

  paint(): void {
    const q = this.player.first.signals.get("q_link");
    if (!q) return;
    const { t, first } = this.player;
    const known = first.recorded(t) === t;
    this.rows.forEach(({ head, mark, value }, k) => {
      const now = (known ? q.at(k, t) : NaN) * (FACTOR[head.unit] ?? 1);
      value.textContent = Number.isFinite(now) ? `${now.toFixed(2)} ${head.unit}` : "–";
      if (head.lower === null || head.upper === null) return;
      const share = Math.max(0, Math.min(1, (now - head.lower) / (head.upper - head.lower)));
      mark.style.left = `${(100 * share).toFixed(2)}%`;
    });
  }

  private row(head: JointHead): HTMLElement {
    const mark = el("i", { class: "mark" });
    const value = el("output", { class: "value", "aria-live": "off" }, "–");
    this.rows.push({ head, mark, value });
    const limited = head.lower !== null && head.upper !== null;
    const bar = el("span", { class: limited ? "range" : "range free", "aria-hidden": "true" }, mark);
    const limits = limited ? [`${number(head.lower ?? NaN)}`, `${number(head.upper ?? NaN)} ${head.unit}`] : ["no limits", ""];
    const made = el("div", { class: "joint" }, el("b", {}, head.name), value, bar, el("small", {}, limits[0] ?? ""), el("small", {}, limits[1] ?? ""));
    if (head.least_margin !== null) made.append(this.margin(head, head.least_margin));
    return made;
  }

  private margin(head: JointHead, margin: number): HTMLElement {
    const text = `least margin ${number(margin)} ${head.unit}`;
    const at = head.at_s;
    if (at === null) return el("span", { class: "margin" }, text);
    return button(`${text} at ${seconds(at)}`, `${head.name}: ${text}; go to ${seconds(at)}`, () => {
      this.player.seek(at);
      this.player.reveal(at);
    }, { class: "margin" });
  }
}
