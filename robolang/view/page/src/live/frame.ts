import type { Hello } from "./messages";

/** One instant of the run. */
export interface Frame {
  readonly t: number;
  readonly values: ReadonlyMap<string, Float32Array>;
}

/** Reads frames: the time as float64, then the numbers of the layout as float32, little-endian. */
export class FrameReader {
  private readonly layout: Hello["layout"];
  private readonly size: number;

  constructor(layout: Hello["layout"]) {
    this.layout = layout;
    this.size = 8 + 4 * layout.reduce((sum, [, count]) => sum + count, 0);
  }

  /** The frame in some bytes; null where they are none. */
  read(bytes: ArrayBuffer): Frame | null {
    if (bytes.byteLength !== this.size) return null;
    const values = new Map<string, Float32Array>();
    let at = 8;
    for (const [name, count] of this.layout) {
      values.set(name, new Float32Array(bytes, at, count));
      at += 4 * count;
    }
    return { t: new DataView(bytes).getFloat64(0, true), values };
  }
}
