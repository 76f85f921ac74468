import { type Object3D, type PerspectiveCamera, Vector3 } from "three";
import type { Severity } from "../contract";
import { el } from "../dom";

export type Kind = "point" | "frame" | "part" | "thing" | Severity;

interface Label {
  readonly element: HTMLElement;
  readonly at: Object3D;
  readonly kind: Kind;
  /** Number of the half of the view, 0 or 1. */
  readonly half: number;
}

/** A label is this high, and a letter this wide, px: they are placed without reading the layout. */
const HEIGHT = 18;
const LETTER = 7;

/** What is shown where names would overlap: findings before points and parts, those before things and frames. */
const ORDER: readonly (readonly Kind[])[] = [["error"], ["warning"], ["note", "point", "part"]];

function rank(kind: Kind): number {
  const found = ORDER.findIndex((kinds) => kinds.includes(kind));
  return found < 0 ? ORDER.length : found;
}

/** Names that stand beside things of the scene. Where two would overlap, the more important or nearer one is shown. */
export class Labels {
  readonly element = el("div", { class: "labels", "aria-hidden": "true" });
  private readonly labels: Label[] = [];
  private readonly place = new Vector3();

  add(text: string, at: Object3D, kind: Kind, half: number): void {
    const element = el("span", { class: `label ${kind}` }, text);
    this.element.append(element);
    this.labels.push({ element, at, kind, half });
  }

  show(on: boolean): void {
    this.element.hidden = !on;
  }

  /** Put each label beside its thing; `width` and `height` are those of one half of the view, px. */
  arrange(camera: PerspectiveCamera, width: number, height: number): void {
    if (this.element.hidden) return;
    const taken: { half: number; x: number; y: number; wide: number }[] = [];
    const placed = this.labels.map((label) => {
      label.at.getWorldPosition(this.place).project(camera);
      return { label, x: ((this.place.x + 1) * width) / 2, y: ((1 - this.place.y) * height) / 2, depth: this.place.z };
    });
    for (const { label, x, y, depth } of placed.sort((a, b) => rank(a.label.kind) - rank(b.label.kind) || a.depth - b.depth)) {
      const wide = label.element.textContent.length * LETTER + 10;
      const clear = depth < 1 && x > 0 && x < width && y > 0 && y < height && taken.every((other) => other.half !== label.half || Math.abs(other.y - y) > HEIGHT || other.x + other.wide < x || x + wide < other.x);
      label.element.classList.toggle("shown", clear);
      if (!clear) continue;
      taken.push({ half: label.half, x, y, wide });
      label.element.style.transform = `translate(${(x + label.half * width + 9).toFixed(1)}px,${(y - HEIGHT / 2).toFixed(1)}px)`;
    }
  }
}
