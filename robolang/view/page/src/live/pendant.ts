import type { JointHead } from "../contract";
import { button, el, select } from "../dom";
import type { Connection } from "./connection";
import { hold, Jogging } from "./jogging";
import type { Reply, Status } from "./messages";

const DIRECTIONS = ["X", "Y", "Z", "RX", "RY", "RZ"] as const;
const FRAMES = [["joint", "Joints"], ["world", "World"], ["base", "Base"], ["tool", "Tool"], ["user", "FRAME"]] as const;
const SPEEDS = [1, 5, 10, 25, 50, 75, 100] as const;
const LINEAR = [0.1, 1, 10, 50, 100] as const;
const ANGULAR = [0.1, 1, 5, 10, 45] as const;

/** The buttons that move the arm by hand, and teach points. */
export class Pendant {
  readonly element = el("section", { class: "pendant", "aria-label": "Pendant", "data-testid": "pendant", hidden: true });
  private readonly connection: Connection;
  private readonly jogging: Jogging;
  private readonly keys = el("div", { class: "jogs", role: "group", "aria-label": "Jog" });
  private readonly said = el("p", { class: "said", role: "status", "data-testid": "pendant-said" });
  private readonly name = el("input", { type: "text", class: "name", maxlength: 64, placeholder: "name", "aria-label": "Name of the point", "data-testid": "teach-name" });
  private readonly replace: HTMLButtonElement;
  private readonly joints: readonly JointHead[];
  private frame: (typeof FRAMES)[number][0] = "world";
  private speed: number = 25;
  private linear: number | null = null;
  private angular: number | null = null;
  private remark: string | null = null;

  constructor(connection: Connection, joints: readonly JointHead[]) {
    this.connection = connection;
    this.joints = joints;
    this.jogging = new Jogging(connection, (reply) => this.say(reply));
    const teach = button("Teach", "Teach the point where the arm stands", () => this.teach(false), { "data-testid": "teach" });
    this.replace = button("Replace it", "Replace the point that is there", () => this.teach(true), { "data-testid": "replace", hidden: true });
    connection.on(() => this.forget());
    this.name.addEventListener("input", () => (this.replace.hidden = true));
    this.element.append(
      el("div", { class: "how" }, el("h2", {}, "Jog"), ...this.choices()),
      this.keys,
      el("div", { class: "how" }, el("h2", {}, "Teach"), this.name, teach, this.replace, this.said),
    );
    addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.stop();
    });
    this.build();
  }

  follow(status: Status): void {
    this.element.hidden = !status.by_hand;
    this.jogging.follow(status);
    const remark = status.remark ?? null;
    if (remark !== this.remark && remark !== null) this.show(remark, true);
    this.remark = remark;
    const free = status.control === "yours" && status.doing !== "program" && status.doing !== "return" && !status.alarm;
    for (const one of this.element.querySelectorAll<HTMLButtonElement | HTMLInputElement>("button, input")) one.disabled = !free;
  }

  /** Stop by hand, whatever moves. */
  private stop(): void {
    this.jogging.end();
    this.connection.command("pause");
  }

  private choices(): HTMLElement[] {
    const held = "held";
    const steps = (list: readonly number[], unit: string): [string, string][] => [[held, `while held (${unit})`], ...list.map((step): [string, string] => [String(step), `${step} ${unit}`])];
    const stepOf = (value: string): number | null => (value === held ? null : Number(value));
    const frame = select("Frame in which a jog counts", FRAMES, this.frame, (value) => {
      this.frame = value;
      this.build();
    });
    const speed = select("Speed of a jog, % of 250 mm/s", SPEEDS.map((each) => [each, `${each} %`] as const), this.speed, (value) => (this.speed = value));
    const sliding = this.joints.some((joint) => joint.unit === "mm");
    const linear = select(sliding ? "Step along X, Y and Z and of joints that slide" : "Step along X, Y and Z", steps(LINEAR, "mm"), held, (value) => (this.linear = stepOf(value)));
    const angular = select("Step of joints and about X, Y and Z", steps(ANGULAR, "deg"), held, (value) => (this.angular = stepOf(value)));
    for (const [name, made] of Object.entries({ frame, speed, linear, angular })) made.dataset.testid = `jog-${name}`;
    return [frame, speed, linear, angular];
  }

  private build(): void {
    const axes = this.frame === "joint" ? this.joints.map((joint, k) => [`J${k + 1}`, joint.unit === "mm"] as const) : DIRECTIONS.map((axis) => [axis, axis.length === 1] as const);
    this.keys.replaceChildren(...axes.map(([axis, linear]) => el("div", { class: "axis" }, this.key(axis, linear, -1), el("b", {}, axis), this.key(axis, linear, 1))));
  }

  /** The button of an axis; a `linear` one goes by mm. */
  private key(axis: string, linear: boolean, sign: number): HTMLElement {
    const word = sign > 0 ? "+" : "−";
    const made = el("button", { type: "button", class: "jog", "aria-label": `Jog ${axis} ${word}`, "data-testid": `jog-${axis}${sign > 0 ? "+" : "-"}` }, word);
    hold(made, () => this.jogging.begin({ axis, sign, frame: this.frame, speed: this.speed, step: linear ? this.linear : this.angular }));
    return made;
  }

  private teach(replace: boolean): void {
    const name = this.name.value.trim();
    if (!name) return;
    this.connection.command("teach", { name, kind: null, replace }, (reply) => {
      this.replace.hidden = reply.code !== "RBL808";
      this.say(reply);
      if (reply.ok) this.said.textContent = [`${name} is taught and saved`, ...(reply.notes ?? [])].join("; ");
    });
  }

  private say(reply: Reply): void {
    this.show(reply.ok ? (reply.notes ?? []).join("; ") : `${reply.code ?? ""} ${reply.message ?? ""}. ${reply.hint ?? ""}`, !reply.ok);
  }

  private show(text: string, refused: boolean): void {
    this.said.textContent = text;
    this.said.classList.toggle("refused", refused);
  }

  /** What was said of a command goes with the next one, also a question that nobody has answered. */
  private forget(): void {
    this.show("", false);
    this.replace.hidden = true;
  }
}
