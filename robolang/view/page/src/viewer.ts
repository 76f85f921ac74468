import { Charts } from "./charts/charts";
import { el } from "./dom";
import { Frames } from "./frames";
import { bindKeys } from "./keys";
import { head } from "./panels/head";
import { Help } from "./panels/help";
import { Joints } from "./panels/joints";
import { Notes } from "./panels/notes";
import { ProgramText } from "./panels/program";
import { Stage } from "./panels/stage";
import { Tabs } from "./panels/tabs";
import { Timeline } from "./panels/timeline";
import { Transport } from "./panels/transport";
import { Player } from "./player";
import type { Run } from "./run";
import { VIEWS } from "./scene/camera";
import type { Sink } from "./sink";
import { ThemeSwitch } from "./theme";

const CYCLES_PER_STEP = 12.5;
/** Numbers in a panel change this often at most while the run plays. */
const PANEL_MS = 120;
const SLOW_S = 0.12;
const SLOW_FRAMES = 6;

/** The page: one player, and the panels that show its time. */
export class Viewer {
  readonly player: Player;
  readonly sink: Sink;
  readonly stage: Stage;
  readonly charts: Charts;
  /** Processor time of the frames drawn while playing, ms: of the page, and of the picture of the robot. */
  readonly cost = { frames: 0, ms: 0, robot: 0 };
  private readonly program: ProgramText;
  private readonly joints: Joints;
  private readonly tabs: Tabs;
  private readonly timeline: Timeline;
  private readonly transport: Transport;
  private readonly help = new Help();
  private readonly theme: ThemeSwitch;
  private readonly frames = new Frames((elapsed) => this.frame(elapsed));
  private painted = -Infinity;
  private slow = 0;

  constructor(host: HTMLElement, runs: readonly Run[], sink: Sink) {
    this.sink = sink;
    this.theme = new ThemeSwitch(() => this.recolour());
    const player = (this.player = new Player(runs));
    this.program = new ProgramText(player, player.first.header.meta.program.text);
    this.joints = new Joints(player);
    const notes = new Notes(player);
    this.tabs = new Tabs([
      { id: "program", name: "Program", content: this.program.element },
      { id: "notes", name: "Notes", content: notes.element },
      { id: "joints", name: "Joints", content: this.joints.element },
    ]);
    const count = (): void => this.tabs.count("notes", notes.count);
    player.on("grown", count);
    count();
    this.stage = new Stage(player);
    this.charts = new Charts(player);
    this.timeline = new Timeline(player);
    this.transport = new Transport(player);
    const foot = el("footer", { class: "foot" }, this.transport.element, this.timeline.element);
    host.replaceChildren(head(player, this.theme.button, this.help.button), this.tabs.element, this.stage.element, this.charts.element, foot, this.help.element);
    host.classList.add("viewer");
    player.on("time", () => this.frames.request());
    player.on("playing", () => this.frames.request());
    this.keys();
    this.paper();
    player.seek(0);
  }

  /** The robot comes last: text and charts do not wait for it. */
  buildStage(): void {
    this.stage.build(() => this.frames.request());
    this.player.seek(this.player.t, this.player.statement);
  }

  /** A live source has added rows or statements. */
  grew(): void {
    this.player.grow();
    this.frames.request();
  }

  private frame(elapsed: number): boolean {
    const { player } = this;
    const before = performance.now();
    if (player.playing && elapsed > 0) player.advance(elapsed);
    if (!player.playing || before - this.painted > PANEL_MS) {
      this.painted = before;
      this.joints.paint();
    }
    const between = performance.now();
    this.stage.view?.render();
    if (player.playing) {
      this.cost.frames += 1;
      this.cost.ms += between - before;
      this.cost.robot += performance.now() - between;
      this.relieve(elapsed);
    }
    return player.playing;
  }

  /** Where frames come too slowly again and again, the robot is drawn with less work. */
  private relieve(elapsed: number): void {
    this.slow = elapsed > SLOW_S ? this.slow + 1 : 0;
    if (this.slow === SLOW_FRAMES) this.stage.view?.simplify();
  }

  private recolour(): void {
    // The switch applies its theme before the panels exist.
    if (!this.stage) return;
    this.charts.spoil("theme");
    this.timeline.draw();
    this.stage.view?.furnish();
    this.frames.request();
  }

  private keys(): void {
    const { player, transport, stage, tabs } = this;
    const step = (by: number) => (event: KeyboardEvent): void => {
      const cycle = player.first.header.cycle_s;
      player.seek(player.t + by * cycle * (event.shiftKey ? CYCLES_PER_STEP : 1));
      player.reveal(player.t);
    };
    const goTo = (t: number): void => {
      player.seek(t);
      player.reveal(t);
    };
    bindKeys({
      " ": () => transport.switch(),
      ArrowLeft: step(-1),
      ArrowRight: step(1),
      PageUp: () => transport.statement(-1),
      PageDown: () => transport.statement(1),
      Home: () => goTo(0),
      End: () => goTo(player.end),
      "+": () => transport.faster(1),
      "-": () => transport.faster(-1),
      z: () => player.zoom(),
      e: () => stage.nextScale(),
      l: () => stage.toggleLabels(),
      p: () => tabs.show("program"),
      n: () => tabs.show("notes"),
      j: () => tabs.show("joints"),
      t: () => this.theme.toggle(),
      "?": () => this.help.toggle(),
      ...Object.fromEntries(VIEWS.map((view, k) => [String(k + 1), () => stage.showView(view)])),
    });
  }

  /** Paper is light, holds the whole text and every chart, and a picture of the robot. */
  private paper(): void {
    const print = (on: boolean) => (): void => {
      this.theme.print(on);
      this.program.print(on);
      this.charts.print(on);
      this.timeline.print(on);
      this.stage.print(on);
    };
    addEventListener("beforeprint", print(true));
    addEventListener("afterprint", print(false));
  }
}
