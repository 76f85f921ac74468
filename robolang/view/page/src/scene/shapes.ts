import { BoxGeometry, BufferGeometry, EdgesGeometry, Float32BufferAttribute, LatheGeometry, SphereGeometry, Vector2 } from "three";
import { RoundedBoxGeometry } from "three/examples/jsm/geometries/RoundedBoxGeometry.js";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { MeshHead, ShapeHead } from "../contract";
import { matrix } from "./pose";

const SEGMENTS = 32;
const RIM = 0.008;
/** Edges of a mesh sharper than this stay sharp. */
const CREASE = Math.PI / 6;

/** The surface of a shape in the frame of its body, without an index so that surfaces can be merged. */
export function surface(shape: ShapeHead, meshes: Readonly<Record<string, MeshHead>>): BufferGeometry {
  const made = inOwnFrame(shape, meshes);
  const bare = made.index ? made.toNonIndexed() : made;
  bare.deleteAttribute("uv");
  return bare.applyMatrix4(matrix(shape.X));
}

/** The edges of a box as pairs of points; null for other shapes. */
export function edges(shape: ShapeHead): BufferGeometry | null {
  if (shape.kind !== "box") return null;
  const [x = 0, y = 0, z = 0] = shape.size;
  return new EdgesGeometry(new BoxGeometry(x, y, z)).applyMatrix4(matrix(shape.X));
}

function inOwnFrame(shape: ShapeHead, meshes: Readonly<Record<string, MeshHead>>): BufferGeometry {
  const [a = 0, b = 0, c = 0] = shape.size;
  if (shape.kind === "box") return new RoundedBoxGeometry(a, b, c, 2, Math.min(0.006, 0.3 * Math.min(a, b, c)));
  if (shape.kind === "sphere") return new SphereGeometry(a, SEGMENTS, SEGMENTS / 2);
  if (shape.kind === "cylinder") return turned(rim(a, b, c), true);
  if (shape.kind === "limb") return turned(roundEnded(a, b, c), false);
  const mesh = meshes[shape.mesh ?? ""];
  return mesh ? triangles(mesh) : new BufferGeometry().setAttribute("position", new Float32BufferAttribute([], 3));
}

/** A profile (radius, height) turned about z. */
function turned(profile: Vector2[], creased: boolean): BufferGeometry {
  const made = new LatheGeometry(profile, SEGMENTS).rotateX(Math.PI / 2);
  return creased ? toCreasedNormals(made, CREASE) : made;
}

/** Profile of a cone stub, centred, whose rims are rounded. */
function rim(low: number, high: number, length: number): Vector2[] {
  const r = Math.min(RIM, 0.3 * low, 0.3 * high, 0.3 * length);
  const half = length / 2;
  const arc = [0, 1, 2, 3].map((k) => (Math.PI / 6) * k);
  return [
    new Vector2(0, -half),
    ...arc.map((u) => new Vector2(low - r + r * Math.sin(u), -half + r - r * Math.cos(u))),
    ...arc.map((u) => new Vector2(high - r + r * Math.cos(u), half - r + r * Math.sin(u))),
    new Vector2(0, half),
  ];
}

/** Profile of two balls and the cone that touches both. */
function roundEnded(start: number, end: number, length: number): Vector2[] {
  const tilt = Math.asin(Math.max(-1, Math.min(1, (start - end) / Math.max(length, 1e-9))));
  const steps = [0, 1, 2, 3, 4, 5, 6, 7, 8].map((k) => k / 8);
  const low = steps.map((u) => -Math.PI / 2 + (tilt + Math.PI / 2) * u);
  const high = steps.map((u) => tilt + (Math.PI / 2 - tilt) * u);
  return [
    ...low.map((u) => new Vector2(Math.max(0, start * Math.cos(u)), start * Math.sin(u))),
    ...high.map((u) => new Vector2(Math.max(0, end * Math.cos(u)), length + end * Math.sin(u))),
  ];
}

function triangles(mesh: MeshHead): BufferGeometry {
  const made = new BufferGeometry();
  made.setAttribute("position", new Float32BufferAttribute(mesh.vertices.flat(), 3));
  made.setIndex(mesh.faces.flat());
  return toCreasedNormals(made, CREASE);
}
