import "uplot/dist/uPlot.min.css";
import "./style.css";
import { el } from "./dom";
import { Connection } from "./live/connection";
import { isLive, SocketSource } from "./live/source";
import { NoSink } from "./sink";
import { EmbeddedSource, type Source } from "./source";
import { thin } from "./thinning";
import { Viewer } from "./viewer";

declare global {
  interface Window {
    /** What tests and people at a console may use. */
    robolang?: object;
  }
}

async function start(): Promise<void> {
  const host = document.getElementById("app") ?? document.body.appendChild(el("main", { id: "app" }));
  try {
    const connection = isLive() ? new Connection() : null;
    const source: Source = connection ? new SocketSource(connection) : new EmbeddedSource();
    const viewer = new Viewer(host, await source.runs(), connection ?? new NoSink());
    expose(viewer);
    viewer.buildStage();
    source.follow(viewer);
    document.body.dataset.state = "ready";
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    host.replaceChildren(el("p", { class: "wait", role: "alert" }, `This page could not show the run: ${reason}`));
    document.body.dataset.state = "failed";
    throw error;
  }
}

function expose(viewer: Viewer): void {
  const { player } = viewer;
  window.robolang = {
    viewer,
    runs: player.runs,
    get t() {
      return player.t;
    },
    get range() {
      return player.range;
    },
    get playing() {
      return player.playing;
    },
    get cost() {
      return viewer.cost;
    },
    seek: (t: number) => player.seek(t),
    play: () => player.play(),
    pause: () => player.pause(),
    thin,
    bodyAt: (run: number, name: string) => viewer.stage.view?.bodyAt(run, name) ?? null,
  };
}

void start();
