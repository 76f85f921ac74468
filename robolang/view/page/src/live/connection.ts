import type { Sink } from "../sink";
import type { FromServer, Reply } from "./messages";

type Fields = Parameters<Sink["command"]>[1];

/** The socket to the run. The token is taken out of the address bar before anything else happens. */
export class Connection implements Sink {
  /** What comes: text, bytes, and the end. */
  message: (message: FromServer) => void = () => undefined;
  frame: (bytes: ArrayBuffer) => void = () => undefined;
  ended: () => void = () => undefined;
  private readonly commanded: (() => void)[] = [];
  private readonly token: string;
  private readonly socket: WebSocket;
  private readonly waiting = new Map<number, (reply: Reply) => void>();
  private last = 0;

  constructor() {
    this.token = new URLSearchParams(location.search).get("token") ?? "";
    history.replaceState(null, "", location.pathname + location.hash);
    this.socket = new WebSocket(`ws://${location.host}/live?token=${this.token}`);
    this.socket.binaryType = "arraybuffer";
    this.socket.addEventListener("message", (event: MessageEvent<unknown>) => this.receive(event.data));
    this.socket.addEventListener("close", () => this.ended());
  }

  /** Open the page as by its printed address: another robot or program needs another page. */
  openAnew(): void {
    this.ended = () => undefined;
    location.replace(`${location.pathname}?token=${this.token}${location.hash}`);
  }

  /** Call this before each command, so that what was answered to the one before goes. */
  on(commanded: () => void): void {
    this.commanded.push(commanded);
  }

  /** Send a command; returns its number, by which its reply is known. */
  command(name: string, fields: Fields = {}, answered?: (reply: Reply) => void): number {
    for (const each of this.commanded) each();
    const id = this.last + 1;
    if (answered) this.waiting.set(id, answered);
    this.sign(name, fields);
    return id;
  }

  /** Send a sign that belongs to a command; nothing is answered. */
  sign(name: string, fields: Fields): void {
    this.last += 1;
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ do: name, id: this.last, ...fields }));
  }

  private receive(data: unknown): void {
    if (data instanceof ArrayBuffer) {
      this.frame(data);
      return;
    }
    const message = JSON.parse(String(data)) as FromServer;
    if (message.kind === "reply") {
      this.waiting.get(message.id)?.(message);
      this.waiting.delete(message.id);
    }
    this.message(message);
  }
}
