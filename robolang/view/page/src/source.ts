import { decode } from "./decode";
import type { Run } from "./run";
import type { Viewer } from "./viewer";

/** Where the runs of a page come from. */
export interface Source {
  runs(): Promise<readonly Run[]>;
  /** Begins to feed a viewer that is built; only a source whose runs still grow has something to do here. */
  follow(viewer: Viewer): void;
}

/** Runs that stand in the page itself, one in each script element with `data-run`. */
export class EmbeddedSource implements Source {
  async runs(): Promise<readonly Run[]> {
    const blocks = [...document.querySelectorAll<HTMLScriptElement>("script[data-run]")];
    if (blocks.length === 0) throw new Error("the page holds no run");
    const runs = await Promise.all(blocks.map((block) => decode(block.textContent ?? "")));
    for (const block of blocks) block.remove();
    return runs;
  }

  follow(): void {
    // A run that stands in the page has ended.
  }
}
