import type { Header, SignalHead } from "./contract";
import { Run, Signal } from "./run";

const FORMAT = 1;
const MASK = 0xffffff;

/** Read a run from the text of its script element: base64 of gzip of [u32 header length][JSON header][columns]. */
export async function decode(text: string): Promise<Run> {
  const raw = await unzip(bytes(text.trim()));
  const length = new DataView(raw.buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(raw.subarray(4, 4 + length))) as Header;
  if (header.format !== FORMAT) throw new Error(`the data has format ${header.format}; this page reads format ${FORMAT}`);
  const signals = new Map<string, Signal>();
  let at = 4 + length;
  for (const head of header.signals) {
    const [columns, next] = unpack(raw, at, head);
    signals.set(head.name, new Signal(head, columns));
    at = next;
  }
  return new Run(header, signals);
}

function bytes(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const out = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) out[k] = text.charCodeAt(k);
  return out;
}

async function unzip(packed: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer>> {
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * Columns of a signal and the offset after them.
 * Three byte planes (low, middle, high) hold, column after column, the zigzag of the difference of two codes modulo 2^24.
 * Code 0: no value; otherwise the value is lo + (code - 1) * step. A constant column has no bytes.
 */
export function unpack(raw: Uint8Array, start: number, head: SignalHead): [Float32Array[], number] {
  const { rows, step, lo } = head;
  const plane = rows * step.filter((size) => size > 0).length;
  let at = start;
  const columns = lo.map((least, j) => {
    const out = new Float32Array(rows);
    const size = step[j] ?? 0;
    if (!(size > 0)) return out.fill(least ?? NaN);
    let code = 0;
    for (let k = 0; k < rows; k++, at++) {
      const zigzag = (raw[at] ?? 0) | ((raw[at + plane] ?? 0) << 8) | ((raw[at + 2 * plane] ?? 0) << 16);
      code = (code + ((zigzag >>> 1) ^ -(zigzag & 1))) & MASK;
      out[k] = code === 0 ? NaN : (least ?? NaN) + (code - 1) * size;
    }
    return out;
  });
  return [columns, start + 3 * plane];
}
