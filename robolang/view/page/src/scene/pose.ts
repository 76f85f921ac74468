import { type Group, Matrix4, type Object3D } from "three";
import type { Pose } from "../contract";

/** A matrix from its rows. */
export function matrix(rows: Pose): Matrix4 {
  const [a = 1, b = 0, c = 0, x = 0, d = 0, e = 1, f = 0, y = 0, g = 0, h = 0, i = 1, z = 0] = rows.flat();
  return new Matrix4().set(a, b, c, x, d, e, f, y, g, h, i, z, 0, 0, 0, 1);
}

/** Put an object where the rows say, relative to its parent. */
export function place<T extends Object3D | Group>(object: T, rows: Pose): T {
  matrix(rows).decompose(object.position, object.quaternion, object.scale);
  return object;
}
