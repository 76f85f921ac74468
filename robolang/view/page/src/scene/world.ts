import { AxesHelper, CircleGeometry, Color, DirectionalLight, Fog, GridHelper, HemisphereLight, Mesh, MeshStandardMaterial, Scene } from "three";
import { token } from "../dom";

/** Light, floor and air around a robot; `size` is that of all that stands there, m. */
export function world(size: number, shadows: boolean): Scene {
  const made = new Scene();
  const air = new Color(token("--air"));
  made.background = air;
  made.fog = new Fog(air, 3.2 * size, 7.5 * size);
  made.add(new HemisphereLight("#ffffff", token("--ground-light"), Number(token("--sky-strength"))));
  made.add(sun(size, shadows), light("#dbe8ff", 0.7, [-2, 1.5, 1.5]), light("#ffffff", 0.5, [2, 2, 0.6]));
  made.add(floor(size), grid(size));
  const axes = new AxesHelper(0.12 * size);
  axes.position.z = 0.004;
  made.add(axes);
  return made;
}

function light(colour: string, strength: number, [x, y, z]: readonly [number, number, number]): DirectionalLight {
  const made = new DirectionalLight(colour, strength);
  made.position.set(x, y, z);
  return made;
}

function sun(size: number, shadows: boolean): DirectionalLight {
  const made = light("#fff4e4", 2, [0.9 * size, -1.1 * size, 2.1 * size]);
  made.castShadow = shadows;
  made.shadow.mapSize.set(2048, 2048);
  const reach = 1.1 * size;
  Object.assign(made.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.2 * size, far: 5 * size });
  made.shadow.bias = -0.0004;
  made.shadow.normalBias = 0.015;
  made.shadow.radius = 4;
  return made;
}

function floor(size: number): Mesh {
  const made = new Mesh(new CircleGeometry(8 * size, 64), new MeshStandardMaterial({ color: token("--floor"), roughness: 1 }));
  made.receiveShadow = true;
  return made;
}

/** Squares of 250 mm. */
function grid(size: number): GridHelper {
  const cells = 2 * Math.ceil((2 * size) / 0.25);
  const made = new GridHelper(cells * 0.25, cells, token("--floor-line"), token("--floor-line-fine"));
  made.rotation.x = Math.PI / 2;
  made.position.z = 0.001;
  return made;
}
