import type { Connection } from "./connection";
import type { Reply, Status } from "./messages";

/** The server stops a jog when it has heard nothing for 200 ms. */
const ALIVE_MS = 50;

export interface JogFields {
  readonly axis: string;
  readonly sign: number;
  readonly frame: string;
  readonly speed: number;
  /** mm or deg; null: as far as it goes while the button is held. */
  readonly step: number | null;
}

/** The one jog that may run: it lasts while this page says so, in time. The page only asks; the server decides. */
export class Jogging {
  private readonly connection: Connection;
  private readonly told: (reply: Reply) => void;
  private id = 0;
  private timer = 0;
  private moves = false;

  /** `told` gets what the server answers. */
  constructor(connection: Connection, told: (reply: Reply) => void) {
    this.connection = connection;
    this.told = told;
    addEventListener("blur", () => this.end());
    addEventListener("pagehide", () => this.end());
    document.addEventListener("visibilitychange", () => {
      if (document.hidden) this.end();
    });
  }

  /** Begin a jog; what is returned ends it, and no other one, when its button is released. */
  begin(fields: JogFields): () => void {
    this.end();
    this.moves = false;
    const id = this.connection.command("jog", { ...fields }, (reply) => {
      this.told(reply);
      if (!reply.ok && this.id === id) this.forget();
    });
    this.id = id;
    this.timer = setInterval(() => this.connection.sign("alive", { jog: this.id }), ALIVE_MS);
    // a step goes to its end
    return () => {
      if (this.id === id && fields.step === null) this.end();
    };
  }

  /** Stop, whatever it is. */
  end(): void {
    if (this.id === 0) return;
    this.connection.sign("release", { jog: this.id });
    this.forget();
  }

  /** A jog that has come to its end needs no more signs. */
  follow(status: Status): void {
    if (status.doing === "jog") this.moves = true;
    else if (this.moves) this.forget();
  }

  private forget(): void {
    clearInterval(this.timer);
    this.id = this.timer = 0;
  }
}

/** Let an element begin something when it is pressed, and end it by every event that may be the last one of a press. */
export function hold(element: HTMLElement, press: () => () => void): void {
  // Of this element: it loses the focus only after another one has been pressed, whose press goes on.
  let release: (() => void) | null = null;
  const begin = (): void => {
    release = press();
  };
  const end = (): void => {
    release?.();
    release = null;
  };
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    begin();
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) element.addEventListener(name, end);
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) begin();
  });
  element.addEventListener("keyup", (event) => {
    if (event.key === " " || event.key === "Enter") end();
  });
}
