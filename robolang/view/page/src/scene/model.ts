import { type BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { BodyHead, Colour, SceneHead, ShapeHead } from "../contract";
import type { Run, Signal } from "../run";
import { place } from "./pose";
import { edges, surface } from "./shapes";

const ROUGHNESS: Partial<Record<Colour, number>> = { body: 0.42, metal: 0.35, rubber: 0.9, table: 0.7, floor: 1 };
/** Metal is black without an environment to mirror: hardly any of it. */
const METALNESS: Partial<Record<Colour, number>> = { metal: 0.15, part: 0.1 };

interface Moving {
  readonly group: Group;
  readonly joint: NonNullable<BodyHead["joint"]>;
  readonly rest: { readonly position: Vector3; readonly quaternion: Quaternion };
  readonly axis: Vector3;
}

/** The bodies of a scene, nested as they hang on one another: the nesting is the forward kinematics. */
export class Model {
  readonly root = new Group();
  readonly bodies = new Map<string, Group>();
  private readonly run: Run;
  private readonly moving: Moving[] = [];
  private readonly turn = new Quaternion();
  private readonly next = new Quaternion();
  private readonly shift = new Vector3();

  constructor(run: Run, scene: SceneHead) {
    this.run = run;
    for (const body of scene.bodies) this.hang(body);
    this.dress(scene);
    this.pose(0);
  }

  /** Put every joint where it was at a time. */
  pose(t: number): void {
    for (const one of this.moving) {
      if (one.joint.source === "part") this.placePart(one, t);
      else this.placeJoint(one, this.value(one.joint, t));
    }
  }

  private value(joint: NonNullable<BodyHead["joint"]>, t: number): number {
    const value = this.run.signals.get(joint.source === "axis" ? "q_link" : "fingers")?.at(joint.index, t) ?? 0;
    return Number.isFinite(value) ? value : 0;
  }

  private placeJoint({ group, joint, rest, axis }: Moving, value: number): void {
    if (joint.kind === "revolute") {
      group.quaternion.copy(rest.quaternion).multiply(this.turn.setFromAxisAngle(axis, value));
    } else {
      group.position.copy(rest.position).add(this.shift.copy(axis).multiplyScalar(value).applyQuaternion(rest.quaternion));
    }
  }

  private placePart({ group, joint }: Moving, t: number): void {
    const parts = this.run.signals.get("parts");
    if (!parts) return;
    const first = 7 * joint.index;
    const [x = NaN, y = NaN, z = NaN] = [0, 1, 2].map((k) => parts.at(first + k, t));
    // Between two frames as the joints are: a part in the hand would lag after it by millimetres.
    const [row, share] = parts.between(t);
    if (!Number.isFinite(x + y + z) || !turned(this.turn, parts, first, row)) return;
    group.position.set(x, y, z);
    group.quaternion.copy(this.turn);
    if (share > 0 && turned(this.next, parts, first, row + 1)) group.quaternion.slerp(this.next, share);
  }

  private hang(body: BodyHead): void {
    const group = place(new Group(), body.X);
    group.name = body.name;
    this.bodies.set(body.name, group);
    (this.bodies.get(body.parent ?? "") ?? this.root).add(group);
    if (!body.joint) return;
    const [x = 0, y = 0, z = 1] = body.joint.axis;
    const rest = { position: group.position.clone(), quaternion: group.quaternion.clone() };
    this.moving.push({ group, joint: body.joint, rest, axis: new Vector3(x, y, z) });
  }

  /** Add the shapes: one mesh for each body and colour. */
  private dress(scene: SceneHead): void {
    const heaps = new Map<string, ShapeHead[]>();
    for (const shape of scene.shapes) {
      const key = `${shape.colour} ${shape.body}`;
      heaps.set(key, [...(heaps.get(key) ?? []), shape]);
    }
    for (const [first, ...others] of heaps.values()) {
      if (!first) continue;
      const body = this.bodies.get(first.body) ?? this.root;
      const shapes = [first, ...others];
      const merged = mergeGeometries(shapes.map((shape) => surface(shape, scene.meshes)));
      const mesh = new Mesh(merged, material(first.colour, scene));
      mesh.castShadow = mesh.receiveShadow = true;
      mesh.name = first.name;
      body.add(mesh);
      if (first.colour === "part") for (const shape of shapes) outline(body, edges(shape), scene);
    }
  }
}

/** Read the quaternion of a part, whose columns begin at `first`, from a row; false where the row has none. */
function turned(out: Quaternion, parts: Signal, first: number, row: number): boolean {
  const [w = NaN, x = NaN, y = NaN, z = NaN] = [3, 4, 5, 6].map((k) => parts.columns[first + k]?.[row] ?? NaN);
  out.set(x, y, z, w).normalize();
  return Number.isFinite(w + x + y + z);
}

function material(colour: Colour, scene: SceneHead): MeshStandardMaterial {
  return new MeshStandardMaterial({
    color: new Color(scene.colours[colour] ?? "#9aa4ae"),
    roughness: ROUGHNESS[colour] ?? 0.55,
    metalness: METALNESS[colour] ?? 0.05,
  });
}

function outline(body: Group, lines: BufferGeometry | null, scene: SceneHead): void {
  if (lines) body.add(new LineSegments(lines, new LineBasicMaterial({ color: scene.colours.edge ?? "#20303a" })));
}
