import { el, select } from "../dom";
import { seconds } from "../format";
import type { Player } from "../player";
import { Chart } from "./chart";

/** Half of the width that a sheet has between its margins, px. */
const PAPER_WIDTH = 340;
const SAMPLED = "These charts show samples. A peak between two of them is in the log alone.";

/** All charts of the page. A chart that nobody sees is neither built nor redrawn. */
export class Charts {
  readonly element = el("section", { class: "charts", "aria-label": "Charts", "data-testid": "charts" });
  private readonly player: Player;
  private readonly charts: readonly Chart[];
  private readonly shown = el("span", { class: "shown", "data-testid": "range" });

  constructor(player: Player) {
    this.player = player;
    this.charts = player.first.header.charts.map((head) => new Chart(player, head));
    const list = el("div", { class: "list" }, ...this.charts.map((chart) => chart.element));
    if (player.first.header.kind === "live") list.append(el("p", { class: "empty", "data-testid": "sampled" }, SAMPLED));
    const jump = select("Go to a chart", [["", "Go to chart …"] as const, ...this.charts.map(({ head }) => [head.id, head.title] as const)], "", (id) => this.goTo(id, jump));
    const keys = player.runs.length < 2 ? [] : player.runs.map((run, k) => el("span", { class: "run-key", title: run.header.label }, el("i", { class: k === 0 ? "key" : "key second", "aria-hidden": "true" }), run.header.label));
    this.element.append(el("div", { class: "bar" }, el("h2", {}, "Charts"), ...keys, this.shown, jump), list);
    const eyes = new IntersectionObserver((entries) => this.seen(entries), { rootMargin: "120px" });
    for (const chart of this.charts) eyes.observe(chart.element);
    player.on("time", () => this.paint());
    player.on("range", () => this.spoil("range"));
    player.on("grown", () => this.spoil("rows"));
    this.describe();
  }

  paint(): void {
    const now = performance.now();
    for (const chart of this.charts) if (chart.visible) chart.paint(now);
  }

  spoil(how: "range" | "theme" | "rows"): void {
    for (const chart of this.charts) chart.spoil(how);
    this.describe();
  }

  /** For paper: every chart, in the width of half a sheet. */
  print(on: boolean): void {
    for (const chart of this.charts) chart.print(on ? PAPER_WIDTH : null);
  }

  private seen(entries: readonly IntersectionObserverEntry[]): void {
    for (const entry of entries) {
      const chart = this.charts.find((one) => one.element === entry.target);
      if (!chart) continue;
      chart.visible = entry.isIntersecting;
      if (!chart.visible) continue;
      chart.draw();
      chart.paint(Infinity);
    }
  }

  private describe(): void {
    const [from, to] = this.player.range;
    this.shown.textContent = this.player.zoomed ? `${from.toFixed(3)} to ${seconds(to)}` : "";
    this.shown.classList.toggle("zoomed", this.player.zoomed);
  }

  private goTo(id: string, jump: HTMLSelectElement): void {
    this.charts.find((chart) => chart.head.id === id)?.element.scrollIntoView({ block: "start" });
    jump.value = "";
  }
}
