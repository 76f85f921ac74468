import { Box3, type BufferGeometry, Group, Mesh, MeshBasicMaterial, type Object3D, OctahedronGeometry, PCFShadowMap, PerspectiveCamera, type Scene, SphereGeometry, Vector3, ACESFilmicToneMapping, AxesHelper, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { SceneHead, Severity } from "../contract";
import { token } from "../dom";
import type { Player } from "../player";
import type { Run } from "../run";
import { aim, type View } from "./camera";
import { type Kind, Labels } from "./labels";
import { Model } from "./model";
import { ToolPath } from "./path";
import { place } from "./pose";
import { world } from "./world";

/** How much work a picture is: shadows and smooth edges, or the least of it for a computer without a graphics card. */
export interface Quality {
  readonly shadows: boolean;
  readonly smooth: boolean;
  readonly pixels: number;
}

export const FINE: Quality = { shadows: true, smooth: true, pixels: 2 };
/** What a picture becomes where frames come slowly. */
const COARSE: Quality = { shadows: false, smooth: true, pixels: 0.75 };
export const PLAIN: Quality = { shadows: false, smooth: false, pixels: 0.5 };

interface Stage {
  readonly run: Run;
  readonly scene: SceneHead;
  readonly model: Model;
  readonly path: ToolPath | null;
  readonly marks: Group;
  world: Scene;
}

const ORBIT_STEP = 0.1;
/** Findings of one code within this distance have one mark. */
const SAME_PLACE_M = 0.01;
const MOST_FINDINGS = 200;

/** The robots of all runs side by side, seen by one camera. */
export class View3D {
  readonly labels = new Labels();
  private readonly host: HTMLElement;
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(34, 1, 0.02, 60);
  private readonly controls: OrbitControls;
  private readonly stages: Stage[];
  private readonly box = new Box3();
  private quality: Quality;
  private top: number;
  private scale = 1;
  private width = 0;
  private height = 0;
  /** Called when the camera shows another view, or none of them. */
  turned: () => void = () => undefined;
  private view: View | null = "iso";
  private dirty = true;

  /** Throws where there is no WebGL. */
  constructor(host: HTMLElement, player: Player, quality: Quality, request: () => void) {
    this.host = host;
    this.quality = quality;
    this.top = Math.max(...player.runs.map((run) => run.largest("tool_error")));
    this.renderer = new WebGLRenderer({ antialias: quality.smooth, powerPreference: "high-performance" });
    this.renderer.shadowMap.enabled = quality.shadows;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.setScissorTest(true);
    const canvas = this.renderer.domElement;
    canvas.dataset.testid = "view3d";
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "The robot; the arrow keys turn the view");
    host.append(canvas, this.labels.element);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.52 * Math.PI;
    this.controls.addEventListener("start", () => this.leave());
    this.controls.addEventListener("change", () => this.ask(request));
    canvas.addEventListener("keydown", (event) => this.key(event));
    this.stages = player.runs.flatMap((run) => this.stage(run));
    this.measure();
    this.furnish();
    this.stages.forEach((stage, k) => this.name(stage, k));
    new ResizeObserver(() => {
      this.resize();
      this.ask(request);
    }).observe(host);
    this.resize();
  }

  /** Largest tool error of all runs, m: the end of the ramp. */
  get largestError(): number {
    return this.top;
  }

  get hasPath(): boolean {
    return this.stages.some((stage) => stage.path !== null);
  }

  /** Position of a body in the world at the shown time, m. */
  bodyAt(run: number, name: string): number[] | null {
    const body = this.stages[run]?.model.bodies.get(name);
    if (!body) return null;
    body.updateWorldMatrix(true, false);
    return body.getWorldPosition(new Vector3()).toArray();
  }

  get shown(): View | null {
    return this.view;
  }

  show(view: View): void {
    this.view = view;
    this.turned();
    const own = view === "iso" ? this.stages[0]?.scene.camera : null;
    if (own) this.camera.position.fromArray(own.position);
    this.controls.target.copy(own ? new Vector3().fromArray(own.target) : aim(this.camera, this.box, view));
    this.controls.update();
    this.dirty = true;
  }

  /** Draw the paths anew: their runs have more rows than before. */
  grow(): void {
    this.top = Math.max(...this.stages.map(({ run }) => run.largest("tool_error")));
    for (const stage of this.stages) stage.path?.grow();
    this.exaggerate(this.scale);
  }

  showPath(on: boolean): void {
    for (const stage of this.stages) if (stage.path) stage.path.line.visible = on;
    this.dirty = true;
  }

  exaggerate(scale: number): void {
    this.scale = scale;
    for (const stage of this.stages) stage.path?.draw(scale, this.top);
    this.dirty = true;
  }

  /** Build light and floor anew, in the colours of the theme. */
  furnish(): void {
    const size = this.box.getSize(new Vector3()).length();
    this.renderer.toneMappingExposure = Number(token("--exposure"));
    for (const stage of this.stages) {
      stage.world = world(size, this.quality.shadows);
      stage.world.add(stage.model.root, stage.marks);
      if (stage.path) stage.world.add(stage.path.line);
    }
    this.exaggerate(this.scale);
  }

  pose(t: number): void {
    for (const stage of this.stages) stage.model.pose(t);
    this.dirty = true;
  }

  invalidate(): void {
    this.dirty = true;
  }

  /** Draw if something changed. */
  render(): void {
    if (!this.dirty || this.width === 0) return;
    this.dirty = false;
    const half = this.width / Math.max(1, this.stages.length);
    this.stages.forEach((stage, k) => {
      this.renderer.setViewport(k * half, 0, half, this.height);
      this.renderer.setScissor(k * half, 0, half, this.height);
      this.renderer.render(stage.world, this.camera);
    });
    this.labels.arrange(this.camera, half, this.height);
  }

  /** Draw with less work: no shadows, fewer pixels. A computer without a graphics card still plays then. */
  simplify(): void {
    if (this.quality !== FINE) return;
    this.quality = COARSE;
    this.renderer.shadowMap.enabled = false;
    this.furnish();
    this.resize();
  }

  /** The picture as it is now, for paper. */
  picture(): string {
    this.dirty = true;
    this.render();
    return this.renderer.domElement.toDataURL("image/png");
  }

  /** The camera is where a person put it. */
  private leave(): void {
    this.view = null;
    this.turned();
  }

  private ask(request: () => void): void {
    this.dirty = true;
    request();
  }

  private stage(run: Run): Stage[] {
    const scene = run.header.meta.scene;
    if (!scene) return [];
    const model = new Model(run, scene);
    const truth = run.signals.get("tool")?.columns;
    const path = truth && truth.length >= 3 ? new ToolPath(run, truth) : null;
    return [{ run, scene, model, path, marks: new Group(), world: world(1, false) }];
  }

  /** What the camera has to show: all that stands there, and the whole path. */
  private measure(): void {
    const point = new Vector3();
    for (const { model, run } of this.stages) {
      model.root.updateMatrixWorld(true);
      this.box.union(new Box3().setFromObject(model.root));
      const tool = run.signals.get("tool");
      for (let row = 0; tool && row < tool.rows; row += 16) {
        const [x = NaN, y = NaN, z = NaN] = tool.columns.map((column) => column[row] ?? NaN);
        if (Number.isFinite(x + y + z)) this.box.expandByPoint(point.set(x, y, z));
      }
    }
    if (this.box.isEmpty()) this.box.set(new Vector3(-0.5, -0.5, 0), new Vector3(0.5, 0.5, 1));
  }

  /** Names and marks of points, frames, parts, things and findings. */
  private name({ scene, run, model, marks }: Stage, half: number): void {
    const dot = new SphereGeometry(0.007, 16, 12);
    const size = Math.max(0.05, 0.08 * scene.reach);
    for (const { name, X } of scene.points) this.label(name, "point", half, marks, place(sign(dot, "--point"), X));
    for (const { name, X } of scene.frames) this.label(name, "frame", half, marks, place(new AxesHelper(size), X));
    for (const { name, p, severity } of findings(run)) this.label(name, severity, half, marks, at(sign(new OctahedronGeometry(0.016), `--${severity}`), p));
    for (const [name, body] of model.bodies) if (name.startsWith("part:")) this.labels.add(name.slice(5), body, "part", half);
    for (const shape of scene.shapes) {
      if (shape.colour !== "table" && shape.colour !== "obstacle") continue;
      this.label(shape.name, "thing", half, model.bodies.get(shape.body) ?? model.root, place(new Group(), shape.X));
    }
  }

  private label(text: string, kind: Kind, half: number, parent: Object3D, mark: Object3D): void {
    parent.add(mark);
    this.labels.add(text, mark, kind, half);
  }

  private resize(): void {
    this.width = this.host.clientWidth;
    this.height = this.host.clientHeight;
    if (this.width === 0 || this.height === 0) return;
    const half = this.width / Math.max(1, this.stages.length);
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, this.quality.pixels));
    this.renderer.setSize(this.width, this.height);
    this.camera.aspect = half / this.height;
    this.camera.updateProjectionMatrix();
    for (const stage of this.stages) stage.path?.line.material.resolution.set(half, this.height);
    if (this.view) this.show(this.view);
    this.dirty = true;
  }

  private key(event: KeyboardEvent): void {
    const [turn, tilt] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] ?? [0, 0];
    if (!turn && !tilt) return;
    event.preventDefault();
    event.stopPropagation();
    this.leave();
    const arm = this.camera.position.clone().sub(this.controls.target);
    const flat = Math.hypot(arm.x, arm.y);
    const length = arm.length();
    const round = Math.atan2(arm.y, arm.x) + (turn ?? 0) * ORBIT_STEP;
    const down = Math.max(0.05, Math.min(0.52 * Math.PI, Math.atan2(flat, arm.z) + (tilt ?? 0) * ORBIT_STEP));
    arm.set(Math.sin(down) * Math.cos(round), Math.sin(down) * Math.sin(round), Math.cos(down)).multiplyScalar(length);
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
  }
}

function sign(geometry: BufferGeometry, colour: string): Mesh {
  return new Mesh(geometry, new MeshBasicMaterial({ color: token(colour) }));
}

function at<T extends Object3D>(object: T, [x = 0, y = 0, z = 0]: readonly number[]): T {
  object.position.set(x, y, z);
  return object;
}

/** Alarms, warnings and notes with a code and a place: their own, or that of the tool at their time; each place once. */
function findings(run: Run): { name: string; p: readonly number[]; severity: Severity }[] {
  const tool = run.signals.get("tool");
  const found = new Map<string, { name: string; p: readonly number[]; severity: Severity }>();
  for (const { code, severity, time_s, p } of run.header.notes) {
    const there = p ?? (time_s !== null && tool ? [0, 1, 2].map((k) => tool.at(k, time_s)) : null);
    if (code === null || !there?.every(Number.isFinite)) continue;
    const key = `${code} ${there.map((x) => Math.round(x / SAME_PLACE_M)).join(" ")}`;
    if (!found.has(key)) found.set(key, { name: code, p: there, severity });
  }
  return [...found.values()].slice(0, MOST_FINDINGS);
}
