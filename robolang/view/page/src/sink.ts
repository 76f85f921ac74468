/** Where commands of the page go. */
export interface Sink {
  command(name: string, fields: Readonly<Record<string, string | number | boolean | null>>): void;
}

/** A page that was opened from disk has nothing to command. */
export class NoSink implements Sink {
  command(): void {
    // There is nobody to command.
  }
}
