import type { Run } from "../run";
import type { Source } from "../source";
import type { Viewer } from "../viewer";
import type { Connection } from "./connection";
import { FrameReader } from "./frame";
import { GrowingRun } from "./growing";
import type { FromServer, Hello, Status } from "./messages";
import { RunPanel } from "./panel";
import { Pendant } from "./pendant";

/** Charts and timeline are drawn anew this often while the run goes on. */
const GROWS_MS = 300;
/** The tool path is drawn anew this often: that costs more. */
const PATH_MS = 1000;
/** A time this near the end is the end. */
const NEAR_S = 0.1;

/** Whether this page is a live one. */
export function isLive(): boolean {
  return document.querySelector("script[data-source=socket]") !== null;
}

/** A run that comes over the socket while it goes on. */
export class SocketSource implements Source {
  private readonly connection: Connection;
  private readonly panel: RunPanel;
  private readonly early: FromServer[] = [];
  private run: GrowingRun | null = null;
  private reader: FrameReader | null = null;
  private pendant: Pendant | null = null;
  private viewer: Viewer | null = null;
  private grown = 0;
  private drawn = 0;
  /** The timer that lets the charts grow once more after the last frame. */
  private due = 0;
  /** Whether the page shows the newest instant; scrubbing back ends that, and the end of the time line begins it again. */
  private following = true;
  private moving = false;
  private over = false;

  constructor(connection: Connection) {
    this.connection = connection;
    this.panel = new RunPanel(connection);
  }

  runs(): Promise<readonly Run[]> {
    return new Promise((resolve, reject) => {
      this.connection.ended = () => reject(new Error("the run has refused this page, or is over; open the address that the command has printed"));
      this.connection.message = (message) => {
        if (message.kind === "hello" && !this.run) resolve([this.greet(message)]);
        else this.early.push(message);
      };
    });
  }

  follow(viewer: Viewer): void {
    this.viewer = viewer;
    const host = viewer.stage.element.parentElement;
    host?.classList.add("live");
    document.body.classList.add("live");
    // Above the grid, whose rows would not let it stay in sight.
    host?.before(...host.querySelectorAll(":scope > .head"), this.panel.element);
    if (this.pendant) host?.append(this.pendant.element);
    viewer.player.on("time", () => {
      if (!this.moving) this.following = viewer.player.t >= viewer.player.end - NEAR_S;
      host?.classList.toggle("following", this.following);
    });
    this.connection.message = (message) => this.take(message);
    this.connection.frame = (bytes) => this.frame(bytes);
    this.connection.ended = () => this.lost();
    for (const message of this.early) this.take(message);
  }

  private greet(hello: Hello): Run {
    this.reader = new FrameReader(hello.layout);
    this.run = new GrowingRun(hello.header, hello.layout);
    this.pendant = new Pendant(this.connection, hello.header.joints);
    return this.run;
  }

  private take(message: FromServer): void {
    switch (message.kind) {
      case "status":
        this.status(message);
        break;
      case "statements":
        this.run?.began(message);
        break;
      case "notes":
        if (this.run) this.run.notes = message.rows;
        this.grow();
        break;
      case "printed":
        this.panel.print(message.text);
        break;
      case "over":
        this.over = true;
        break;
      case "refused":
        throw new Error(`${message.code} ${message.message}`);
      case "hello":
        this.connection.openAnew();
        break;
      case "reply":
        break;
    }
  }

  private status(status: Status): void {
    document.body.dataset.run = status.state;
    this.panel.follow(status);
    this.pendant?.follow(status);
    this.markDue(status);
    this.grow();
  }

  /** Mark the line whose statement comes next, while the program stands. */
  private markDue(status: Status): void {
    const stands = status.state === "paused" || (status.can_continue ?? false);
    const line = stands ? (status.next ?? 0) : 0;
    for (const row of document.querySelectorAll<HTMLElement>(".line.due")) row.classList.remove("due");
    document.querySelector(`.line[data-line="${line}"]`)?.classList.add("due");
  }

  private frame(bytes: ArrayBuffer): void {
    const { run, viewer } = this;
    const frame = this.reader?.read(bytes);
    if (!frame || !run || !viewer) return;
    run.add(frame);
    viewer.player.extend();
    if (performance.now() - this.grown > GROWS_MS) this.grow();
    // No frame may come after this one.
    else if (this.due === 0) this.due = setTimeout(() => this.grow(), GROWS_MS);
    if (this.following) this.show(run.end);
  }

  private show(t: number): void {
    this.moving = true;
    this.viewer?.player.seek(t);
    this.moving = false;
  }

  private grow(): void {
    clearTimeout(this.due);
    this.due = 0;
    this.grown = performance.now();
    this.run?.stretch();
    this.viewer?.grew();
    if (this.grown - this.drawn < PATH_MS) return;
    this.drawn = this.grown;
    this.viewer?.stage.grow();
  }

  private lost(): void {
    this.pendant?.element.remove();
    this.grow();
    document.body.dataset.run = "over";
    this.panel.end(this.over ? "The run is over. This page keeps what it has shown." : "The connection to the run is lost. This page keeps what it has shown.");
  }
}
