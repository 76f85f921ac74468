import { button, el, select } from "../dom";
import { number, seconds } from "../format";
import type { Player } from "../player";
import { type View, VIEWS } from "../scene/camera";
import { FINE, PLAIN, View3D } from "../scene/view3d";
import { named } from "./timeline";

const VIEW_NAMES: Readonly<Record<View, string>> = { iso: "3-D", front: "Front", side: "Side", top: "Top" };
export const SCALES = [1, 10, 100, 500] as const;

/** The middle of the page: the robot, or words where it cannot be drawn; over it the running statement and the views. */
export class Stage {
  readonly element = el("section", { class: "stage", "aria-label": "Robot", "data-testid": "stage" });
  view: View3D | null = null;
  private readonly player: Player;
  private readonly now = el("p", { class: "caption", "data-testid": "now", "aria-live": "off" });
  private readonly snapshot = el("img", { class: "snapshot paper", alt: "The robot at the shown time" });
  /** The error of the last colour of the path. */
  private readonly most = el("small", {});
  private readonly unknown = el("p", { class: "unknown", role: "status", hidden: true, "data-testid": "unknown" });
  private scale: HTMLSelectElement | null = null;
  private labelled: HTMLInputElement | null = null;

  constructor(player: Player) {
    this.player = player;
    this.element.append(this.now, this.unknown);
    if (player.runs.length > 1) for (const [k, run] of player.runs.entries()) this.element.append(el("p", { class: `who side-${k}` }, run.header.label));
    player.on("time", () => this.paint());
    this.paint();
  }

  /** Draw the robot; where that fails, say so in its place. The rest of the page does not need it. */
  build(request: () => void): void {
    if (!this.player.first.header.meta.scene) {
      this.refuse("This run carries no scene, so there is no robot to draw.");
      return;
    }
    const host = el("div", { class: "canvas" });
    this.element.prepend(host);
    try {
      this.view = new View3D(host, this.player, location.hash === "#plain" ? PLAIN : FINE, request);
    } catch (error) {
      host.remove();
      const reason = error instanceof Error ? error.message : String(error);
      const why = reason.includes("WebGL") ? "This browser offers no WebGL, so the robot is not drawn." : "The robot cannot be drawn from what the run says of it.";
      this.refuse(`${why} Program, timeline and charts work without it.`, reason);
      return;
    }
    this.controls(this.view);
  }

  /** The run has more rows: its path is drawn anew. */
  grow(): void {
    if (!this.view) return;
    this.view.grow();
    this.most.textContent = millimetres(this.view.largestError);
  }

  showView(view: View): void {
    this.view?.show(view);
  }

  nextScale(): void {
    if (!this.scale) return;
    this.scale.selectedIndex = (this.scale.selectedIndex + 1) % SCALES.length;
    this.view?.exaggerate(SCALES[this.scale.selectedIndex] ?? 1);
  }

  toggleLabels(): void {
    if (this.labelled) this.labelled.click();
  }

  print(on: boolean): void {
    if (!this.view) return;
    if (on) {
      this.snapshot.src = this.view.picture();
      this.element.append(this.snapshot);
    } else this.snapshot.remove();
  }

  private paint(): void {
    const { t, first } = this.player;
    const known = first.recorded(t);
    this.view?.pose(known);
    this.element.classList.toggle("dim", known !== t);
    this.unknown.hidden = known === t;
    this.unknown.textContent = known === t ? "" : `Not recorded here. The robot stands as at ${seconds(known)}.`;
    const one = this.player.first.statements.all[this.player.statement];
    const text = one ? named(one) : "";
    if (this.now.textContent !== text) this.now.textContent = text;
  }

  private refuse(words: string, reason?: string): void {
    this.element.classList.add("empty");
    this.element.append(el("p", { class: "words", role: "status", title: reason, "data-testid": "no3d" }, words));
  }

  private controls(view: View3D): void {
    const views = VIEWS.map((name, k) => button(VIEW_NAMES[name], `View: ${VIEW_NAMES[name]} (${k + 1})`, () => view.show(name), { "data-view": name }));
    this.element.append(el("div", { class: "views", role: "group", "aria-label": "View" }, ...views));
    const press = (): void => views.forEach((one, k) => one.setAttribute("aria-pressed", String(VIEWS[k] === view.shown)));
    view.turned = press;
    press();
    this.labelled = el("input", { type: "checkbox", checked: true });
    this.labelled.addEventListener("change", () => {
      view.labels.show(this.labelled?.checked ?? true);
      view.invalidate();
      this.player.seek(this.player.t, this.player.statement);
    });
    const legend = el("div", { class: "legend", "data-testid": "legend" });
    if (view.hasPath) legend.append(...this.pathControls(view));
    legend.append(el("label", {}, this.labelled, "Labels"));
    this.element.append(legend);
  }

  private pathControls(view: View3D): HTMLElement[] {
    const shown = el("input", { type: "checkbox", checked: true });
    shown.addEventListener("change", () => {
      view.showPath(shown.checked);
      this.player.seek(this.player.t, this.player.statement);
    });
    this.scale = select("Size of the drawn error", SCALES.map((k) => [k, k === 1 ? "true size" : `error × ${k}`] as const), 1, (k) => {
      view.exaggerate(k);
      this.player.seek(this.player.t, this.player.statement);
    });
    // A run that still goes on has no error yet.
    if (!(view.largestError > 0) && this.player.first.header.kind !== "live") return [el("label", {}, shown, "Tool path")];
    this.most.textContent = millimetres(view.largestError);
    const ramp = el("span", { class: "ramp", title: "Distance of the tool point from its commanded place" }, el("small", {}, "0"), el("i", {}), this.most);
    return [el("label", {}, shown, "Tool path"), ramp, this.scale];
  }
}

const millimetres = (metres: number): string => `${number(metres * 1000)} mm`;
