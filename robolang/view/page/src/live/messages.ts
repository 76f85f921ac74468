import type { Header, Note, Statement } from "../contract";

/** What the server sends, as JSON; frames are binary (`frame.ts`). Written by `robolang.view.exchange`. */
export type FromServer = Hello | Status | Began | Noted | Printed | Reply | Refused | Over;

/** The first message: the run before it begins, and what a frame holds. Another one: the run is another one. */
export interface Hello {
  readonly kind: "hello";
  /** Names of a frame after its time, and how many numbers each has. */
  readonly layout: readonly (readonly [string, number])[];
  readonly header: Header;
}

/** `none`: pages only watch, since a prompt drives the arm. */
export type Control = "yours" | "free" | "other" | "none";

export interface Alarm {
  readonly code: string;
  readonly message: string;
  readonly hint: string;
  readonly line: number | null;
}

/** Where the run stands, whole; sent when it changes. */
export interface Status {
  readonly kind: "status";
  readonly control: Control;
  readonly state: "starting" | "running" | "paused" | "waiting" | "stopped" | "done" | "alarm";
  readonly doing?: "nothing" | "program" | "jog" | "return";
  readonly over?: boolean;
  /** The run is over, and nothing is carried out any more. */
  readonly finished?: boolean;
  /** The line that comes next; of a program that was interrupted the one at which it goes on. */
  readonly next?: number | null;
  readonly alarm?: Alarm | null;
  readonly fault?: string | null;
  readonly can_continue?: boolean;
  readonly mode?: "AUTO" | "MANUAL";
  readonly override?: number;
  readonly pace?: number | null;
  readonly by_hand?: boolean;
  /** Of the jog that has ended last, until the next command. */
  readonly remark?: string | null;
  readonly holding?: string | null;
  /** Number, state, and whether it is held in that state. */
  readonly inputs?: readonly (readonly [number, number, boolean])[];
  readonly outputs?: readonly (readonly [number, number])[];
}

export interface Began {
  readonly kind: "statements";
  /** Place of the first row in the run; what a page has from there on was taken back. */
  readonly from: number;
  readonly rows: readonly Omit<Statement, "duration_s">[];
}

/** All notes up to now, in place of those before. */
export interface Noted {
  readonly kind: "notes";
  readonly rows: readonly Note[];
}

export interface Printed {
  readonly kind: "printed";
  readonly text: string;
}

/** The answer to a command, by its number. */
export interface Reply {
  readonly kind: "reply";
  readonly id: number;
  readonly ok: boolean;
  readonly notes?: readonly string[];
  readonly code?: string;
  readonly message?: string;
  readonly hint?: string;
}

/** A message of this page was no command: a defect of the page. */
export interface Refused {
  readonly kind: "refused";
  readonly code: string;
  readonly message: string;
}

/** The run is over, and the server goes. */
export interface Over {
  readonly kind: "over";
}
