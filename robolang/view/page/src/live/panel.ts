import { button, el, select } from "../dom";
import { OWN_KEYS } from "../keys";
import type { Connection } from "./connection";
import type { Reply, Status } from "./messages";

/** `view --speed` may add one. */
const PACES: readonly number[] = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const STATES: Readonly<Record<Status["state"], string>> = {
  starting: "Starting",
  running: "Running",
  paused: "Paused",
  waiting: "Waiting",
  stopped: "Stopped",
  done: "Ended",
  alarm: "Alarm",
};
const MOST_PRINTED = 200;

/** Where the run stands; a program that a stop or an alarm has interrupted can go on, so it has not ended. */
function wordsOf({ state, doing, over, can_continue, next }: Status): string {
  if (doing === "jog") return "Jog";
  if (doing === "return") return "Returning to where it was left";
  return over && can_continue && state !== "alarm" ? `Stopped at line ${next ?? "1"}` : STATES[state];
}

/** The strip under the head: where the run stands, its buttons, its signals, and who has control. */
export class RunPanel {
  readonly element = el("section", { class: "strip", "aria-label": "Run", "data-testid": "strip" });
  private readonly connection: Connection;
  private readonly state = el("span", { class: "outcome", "data-testid": "state", role: "status" });
  private readonly buttons: Readonly<Record<string, HTMLButtonElement>>;
  private readonly override = el("input", { type: "range", min: 1, max: 100, value: 100, "aria-label": "Override, %", "data-testid": "override", ...OWN_KEYS });
  private readonly percent = el("output", {}, "100 %");
  private paces = PACES;
  private pace = this.choosePace();
  private readonly signals = el("span", { class: "signals", "data-testid": "signals" });
  private readonly control = el("span", { class: "control", "data-testid": "control" });
  /** The alarm that is latched: it stays until it is acknowledged, whatever is answered meanwhile. */
  private readonly problem = el("p", { class: "problem", role: "alert", "data-testid": "problem" });
  private readonly words = el("p", { class: "words", role: "alert", "data-testid": "words" });
  private readonly printed = el("output", { class: "printed", "aria-live": "off", "data-testid": "printed" });
  /** The slider is moved, and overrides are on their road: it must not jump back to what was before them. */
  private sliding = false;
  private overrides = 0;

  constructor(connection: Connection) {
    this.connection = connection;
    connection.on(() => (this.words.textContent = ""));
    const send = (word: string) => (): void => void this.send(word);
    this.buttons = {
      start: button("Start", "Go on with the program; after a stop or an alarm the statement that was interrupted begins anew", send("start"), { "data-testid": "start" }),
      pause: button("Pause", "Bring the arm to rest on its path (Esc)", send("pause"), { "data-testid": "pause" }),
      step: button("Step", "Carry out one statement", send("step"), { "data-testid": "step" }),
      stop: button("Stop", "Stop the arm and interrupt the program. After Reset, Start begins the interrupted statement anew, Restart goes to the first one.", send("stop"), { "data-testid": "stop" }),
      reset: button("Reset", "Acknowledge the alarm", send("reset"), { "data-testid": "reset" }),
      restart: button("Restart", "Put the program before its first statement. Arm, parts, signals and time stay as they are; to begin with a new cell, end the command and give it again.", send("restart"), { "data-testid": "restart" }),
      end: button("End", "End robolang view", send("end"), { "data-testid": "end" }),
    };
    this.override.addEventListener("input", () => {
      this.sliding = true;
      this.percent.textContent = `${this.override.value} %`;
    });
    this.override.addEventListener("change", () => {
      this.sliding = false;
      this.overrides += 1;
      this.send("override", { percent: Number(this.override.value) }, () => (this.overrides -= 1));
    });
    this.element.append(
      this.state,
      el("span", { class: "buttons", role: "group", "aria-label": "Run the program" }, ...Object.values(this.buttons)),
      el("label", { class: "override" }, "Override", this.override, this.percent),
      this.pace,
      this.signals,
      this.control,
      this.printed,
      this.problem,
      this.words,
    );
  }

  follow(status: Status): void {
    const { state, alarm, fault } = status;
    const doing = status.doing ?? "nothing";
    const words = wordsOf(status);
    this.state.textContent = status.mode ? `${words} · ${status.mode}` : words;
    this.state.className = `outcome ${alarm ? "error" : state === "paused" || words.startsWith("Stopped") ? "warning" : "ok"}`;
    const problem = alarm ? `${alarm.code} ${alarm.message}${alarm.line ? `, line ${alarm.line}` : ""}. ${alarm.hint}` : (fault ?? "");
    // Written when it changes only: a reader of screens says it each time.
    if (this.problem.textContent !== problem) this.problem.textContent = problem;
    this.enable(status, doing);
    if (!this.sliding && this.overrides === 0 && status.override !== undefined) {
      this.override.value = String(status.override);
      this.percent.textContent = `${Math.round(status.override)} %`;
    }
    this.pace.hidden = status.pace === null || status.pace === undefined;
    if (status.pace) this.showPace(status.pace);
    this.showSignals(status);
    this.showControl(status);
    if (status.finished) this.end("The run is over. Its command ends when this page is closed.");
  }

  print(text: string): void {
    const line = el("span", {}, text);
    this.printed.append(line);
    while (this.printed.childElementCount > MOST_PRINTED) this.printed.firstElementChild?.remove();
    this.printed.scrollTop = this.printed.scrollHeight;
  }

  /** Say that nothing more comes. */
  end(words: string): void {
    this.element.classList.add("over");
    this.words.textContent = words;
    for (const one of this.element.querySelectorAll<HTMLButtonElement>("button, input, select")) one.disabled = true;
  }

  private enable(status: Status, doing: string): void {
    const stands = doing === "nothing" && status.control === "yours";
    const ready = stands && !status.alarm;
    const goes = ready && (!status.over || (status.can_continue ?? false));
    const hand = status.by_hand ?? false;
    // Stopping needs no control.
    const moves = doing !== "nothing" && status.control !== "none";
    const can: Readonly<Record<string, boolean>> = {
      start: goes,
      step: goes,
      pause: moves,
      stop: !status.alarm && (moves || (status.control === "yours" && !status.over)),
      reset: stands && Boolean(status.alarm),
      restart: ready,
      end: status.control === "yours",
    };
    for (const [name, made] of Object.entries(this.buttons)) {
      made.disabled = !can[name];
      made.hidden = status.control === "none" || (!hand && (name === "restart" || name === "end" || name === "reset"));
    }
    this.override.disabled = this.pace.disabled = status.control !== "yours";
  }

  private choosePace(): HTMLSelectElement {
    return select("Simulated seconds in one of wall time", this.paces.map((each) => [each, `${each} × real time`] as const), 1, (factor) => this.send("pace", { factor }), { "data-testid": "pace" });
  }

  private showPace(pace: number): void {
    if (!this.paces.includes(pace)) {
      this.paces = [...this.paces, pace].sort((a, b) => a - b);
      const { hidden, disabled } = this.pace;
      const made = Object.assign(this.choosePace(), { hidden, disabled });
      this.pace.replaceWith(made);
      this.pace = made;
    }
    if (this.pace.value !== String(pace)) this.pace.value = String(pace);
  }

  private showSignals(status: Status): void {
    const key = JSON.stringify([status.inputs, status.outputs, status.holding, status.control]);
    if (this.signals.dataset.of === key) return;
    this.signals.dataset.of = key;
    const inputs = (status.inputs ?? []).map(([number, state, forced]) => this.input(number, state, forced, status.control !== "yours"));
    const outputs = (status.outputs ?? []).map(([number, state]) => el("span", { class: `lamp ${state ? "on" : ""}`, title: `Output ${number}` }, `OUT ${number} ${state}`));
    this.signals.replaceChildren(...inputs, ...outputs, ...(status.holding ? [el("span", { class: "lamp on" }, `holds ${status.holding}`)] : []));
  }

  private input(number: number, state: number, forced: boolean, watching: boolean): HTMLElement {
    const set = (value: number | null) => (): void => void this.send("input", { number, state: value });
    const flip = button(`IN ${number} ${state}${forced ? " forced" : ""}`, `Hold input ${number} ${state ? "off" : "on"}`, set(state ? 0 : 1), { class: `lamp ${state ? "on" : ""}`, "data-testid": `in-${number}`, disabled: watching });
    if (!forced) return flip;
    return el("span", {}, flip, button("auto", `Give input ${number} back to the cell file`, set(null), { class: "auto", disabled: watching }));
  }

  private showControl(status: Status): void {
    if (this.control.dataset.of === status.control) return;
    this.control.dataset.of = status.control;
    const made = {
      yours: ["You have control", button("Give", "Give control back, so that another page can take it", () => this.send("give"), { "data-testid": "give" })],
      free: ["No page has control", button("Take", "Take control of the arm", () => this.send("take"), { "data-testid": "take" })],
      other: ["You watch: another page has control"],
      none: ["You watch: the prompt has control"],
    }[status.control];
    this.control.replaceChildren(...made);
  }

  private send(word: string, fields: Parameters<Connection["command"]>[1] = {}, done?: () => void): void {
    this.connection.command(word, fields, (reply) => {
      this.answered(reply);
      done?.();
    });
  }

  private answered(reply: Reply): void {
    if (!reply.ok) this.words.textContent = `${reply.code ?? ""} ${reply.message ?? ""}. ${reply.hint ?? ""}`;
  }
}
