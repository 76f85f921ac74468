/** What a page carries of a run: the shapes of its JSON. Written by `robolang.view.packing`; inside are SI units. */

/** Rows of a 4 x 4 matrix: a pose. */
export type Pose = readonly (readonly number[])[];

export type Base = "tick" | "cycle" | "frame" | "pairs";

export interface SignalHead {
  readonly name: string;
  readonly base: Base;
  /** Seconds of the first row, and between two rows. */
  readonly t0: number;
  readonly dt: number;
  readonly rows: number;
  readonly columns: number;
  /** Least value of each column; null: the column has no value at all. */
  readonly lo: readonly (number | null)[];
  /** Size of one code of each column; 0: the column is constant and has no bytes. */
  readonly step: readonly number[];
}

export type Role = "value" | "command" | "limit" | "step";

export interface SeriesHead {
  readonly label: string;
  readonly signal: string;
  readonly column: number;
  /** From the signal's unit to the chart's. */
  readonly scale: number;
  /** A column that is subtracted before scaling. */
  readonly minus: readonly [string, number] | null;
  readonly role: Role;
}

export interface ChartHead {
  readonly id: string;
  readonly title: string;
  readonly unit: string;
  readonly series: readonly SeriesHead[];
  readonly band: readonly [number, number] | null;
  /** The series are levels of 0 and 1, each drawn in its own lane. */
  readonly lanes?: boolean;
}

export type Severity = "error" | "warning" | "note" | "print";

export interface Note {
  readonly time_s: number | null;
  readonly line: number | null;
  readonly code: string | null;
  readonly severity: Severity;
  readonly text: string;
  /** The place of a finding in the world, m. */
  readonly p?: readonly number[] | null;
}

export interface JointHead {
  readonly name: string;
  readonly unit: string;
  readonly lower: number | null;
  readonly upper: number | null;
  readonly least_margin: number | null;
  readonly at_s: number | null;
}

export interface Statement {
  readonly line: number | null;
  readonly number: number | null;
  readonly text: string;
  readonly start_s: number;
  readonly duration_s: number;
  readonly path_deviation_mm?: number | null;
  readonly peak_torque_pct?: number | null;
}

export interface Report {
  readonly ok?: boolean;
  readonly robot?: string;
  readonly servo?: string;
  readonly sim_time_s?: number;
  readonly statements: readonly Statement[];
  readonly alarms?: readonly { readonly code: string }[];
  readonly warnings?: readonly unknown[];
}

export interface BodyHead {
  readonly name: string;
  readonly parent: string | null;
  /** Pose in the parent where the joint is at 0. */
  readonly X: Pose;
  readonly joint: JointOfBody | null;
}

export interface JointOfBody {
  readonly kind: "revolute" | "prismatic";
  readonly axis: readonly number[];
  readonly source: "axis" | "finger" | "part";
  readonly index: number;
}

export type Colour = "body" | "cover" | "accent" | "metal" | "rubber" | "palm" | "table" | "leg" | "part" | "edge" | "floor" | "obstacle";

export interface ShapeHead {
  readonly body: string;
  readonly kind: "box" | "cylinder" | "limb" | "sphere" | "mesh";
  readonly X: Pose;
  readonly size: readonly number[];
  readonly colour: Colour;
  readonly name: string;
  readonly mesh?: string | null;
}

export interface MeshHead {
  readonly vertices: readonly (readonly number[])[];
  readonly faces: readonly (readonly number[])[];
}

export interface Mark {
  readonly name: string;
  readonly X: Pose;
}

export interface SceneHead {
  readonly bodies: readonly BodyHead[];
  readonly shapes: readonly ShapeHead[];
  readonly colours: Readonly<Record<string, string>>;
  readonly meshes: Readonly<Record<string, MeshHead>>;
  readonly frames: readonly Mark[];
  readonly points: readonly Mark[];
  /** The view that the cell asks for, m; null: all of it. */
  readonly camera?: { readonly position: readonly number[]; readonly target: readonly number[] } | null;
  readonly robot: string;
  readonly reach: number;
}

export interface Meta {
  readonly program: { readonly name: string; readonly text: string };
  readonly scene: SceneHead | null;
  readonly report: Report;
}

export interface Header {
  readonly format: number;
  readonly kind?: "run" | "plan" | "live";
  readonly label: string;
  readonly duration_s: number;
  readonly tick_s: number;
  readonly cycle_s: number;
  readonly thinned: { readonly every_s: number; readonly text: string } | null;
  readonly meta: Meta;
  readonly signals: readonly SignalHead[];
  readonly charts: readonly ChartHead[];
  readonly notes: readonly Note[];
  readonly joints: readonly JointHead[];
}
