import { type Box3, type PerspectiveCamera, Vector3 } from "three";

export type View = "iso" | "front" | "side" | "top";
export const VIEWS: readonly View[] = ["iso", "front", "side", "top"];

/** Where the camera stands, seen from what it shows. The robot's x points to the front. */
const FROM: Readonly<Record<View, readonly [number, number, number]>> = {
  iso: [0.95, -0.95, 0.62],
  front: [1, 0, 0.06],
  side: [0, -1, 0.06],
  top: [-0.0005, 0, 1],
};

/** Part of the picture that stays free at its edges. */
const MARGIN = 1.12;

/** Put the camera so that a box fills the picture, whatever the picture's form. Returns what it aims at. */
export function aim(camera: PerspectiveCamera, box: Box3, view: View): Vector3 {
  const centre = box.getCenter(new Vector3());
  const toward = new Vector3(...FROM[view]).normalize();
  const right = new Vector3().crossVectors(camera.up, toward).normalize();
  const up = new Vector3().crossVectors(toward, right);
  const tall = Math.tan((camera.fov * Math.PI) / 360) / MARGIN;
  const wide = tall * camera.aspect;
  let distance = 0;
  for (let k = 0; k < 8; k++) {
    const corner = new Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z).sub(centre);
    const reach = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / tall);
    distance = Math.max(distance, reach + corner.dot(toward));
  }
  camera.position.copy(centre).addScaledVector(toward, distance);
  camera.lookAt(centre);
  return centre;
}
