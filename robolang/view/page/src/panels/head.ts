import type { Note, Report, Statement } from "../contract";
import { el } from "../dom";
import { number, seconds } from "../format";
import type { Player } from "../player";

/** The head of the page: what ran, on what, how it ended. */
export function head(player: Player, ...tools: readonly HTMLElement[]): HTMLElement {
  const { header } = player.first;
  const { meta } = header;
  document.title = `${meta.program.name} · robolang`;
  const made = el("header", { class: "head" }, el("h1", { "data-testid": "title" }, meta.program.name), outcome(player), el("div", { class: "tools" }, ...tools));
  made.append(facts(player));
  const second = player.runs[1];
  if (second && second.header.meta.program.text !== meta.program.text) {
    made.append(el("p", { class: "remark" }, `${second.header.label} executed another text; the one shown is that of ${header.label}.`));
  }
  made.append(thinned(player));
  return made;
}

/** What is not shown of the runs: each text once, with the name of its run where there are two. */
function thinned(player: Player): HTMLElement {
  const made = el("p", { class: "remark", "data-testid": "thinned" });
  const say = (): void => {
    const texts = player.runs.filter((run) => run.thinned).map((run) => (player.runs.length > 1 ? `${run.header.label}: ${run.thinned}` : run.thinned));
    made.textContent = made.title = texts.join(" ");
    made.hidden = texts.length === 0;
  };
  player.on("grown", say);
  say();
  return made;
}

function outcome(player: Player): HTMLElement {
  const made = el("div", { class: "outcomes", "data-testid": "outcome" });
  for (const run of player.runs) {
    const [kind, words] = run.header.kind === "plan" ? planned(run.header.notes) : ending(run.header.meta.report, run.header.kind ?? "run");
    const name = player.runs.length > 1 ? el("span", { class: "who" }, run.header.label) : "";
    made.append(el("span", { class: `outcome ${kind}` }, name, words));
  }
  return made;
}

function ending(report: Report, kind: "run" | "plan" | "live"): [string, string] {
  if (kind === "live") return ["note", "Live"];
  const alarm = report.alarms?.[0]?.code;
  if (report.ok === false) return ["error", alarm ? `Stopped by ${alarm}` : "Stopped"];
  const warnings = report.warnings?.length ?? 0;
  if (warnings > 0) return ["warning", `Ended with ${warnings} warning${warnings === 1 ? "" : "s"}`];
  return ["ok", "Ran to its end"];
}

/** How a planned motion came out: its findings, errors before warnings. */
function planned(notes: readonly Note[]): [string, string] {
  for (const severity of ["error", "warning"] as const) {
    const count = notes.filter((note) => note.severity === severity).length;
    if (count > 0) return [severity, `Planned, ${count} ${severity}${count === 1 ? "" : "s"}`];
  }
  return ["ok", "Planned motion"];
}

function facts(player: Player): HTMLElement {
  const made = el("dl", { class: "facts" });
  const { report, scene } = player.first.header.meta;
  add(made, "Robot", report.robot ?? scene?.robot ?? "");
  add(made, "Servo", both(player, (run) => run.header.meta.report.servo ?? ""));
  if (player.first.header.kind === "live") return made;
  add(made, "Duration", both(player, (run) => seconds(run.end)));
  add(made, "Tool error", both(player, (run) => millimetres(run.largest("tool_error") * 1000)));
  add(made, "Off path", both(player, (run) => millimetres(most(run.header.meta.report, (one) => one.path_deviation_mm))));
  add(made, "Peak torque", both(player, (run) => percent(most(run.header.meta.report, (one) => one.peak_torque_pct))));
  return made;
}

function both(player: Player, show: (run: Player["first"]) => string): string {
  const texts = player.runs.map(show);
  if (texts.every((text) => text === "")) return "";
  return [...new Set(texts)].length === 1 ? (texts[0] ?? "") : texts.map((text) => text || "–").join(" | ");
}

function add(list: HTMLElement, name: string, value: string): void {
  if (value) list.append(el("div", {}, el("dt", {}, name), el("dd", {}, value)));
}

function most(report: Report, value: (one: Statement) => number | null | undefined): number {
  return Math.max(0, ...report.statements.map((one) => value(one) ?? 0));
}

const millimetres = (value: number): string => (value > 0 ? `${number(value)} mm` : "");
const percent = (value: number): string => (value > 0 ? `${value.toFixed(0)} %` : "");
