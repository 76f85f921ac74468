/** Draws at most once for each frame of the screen, and only when something changed. */
export class Frames {
  private readonly draw: (seconds: number) => boolean;
  private pending = 0;
  private last = 0;

  /** `draw` gets the seconds since the frame before, 0 after a rest, and returns whether it wants the next frame too. */
  constructor(draw: (seconds: number) => boolean) {
    this.draw = draw;
  }

  request(): void {
    if (this.pending === 0) this.pending = requestAnimationFrame((now) => this.frame(now));
  }

  private frame(now: number): void {
    this.pending = 0;
    // A tab that was hidden must not jump ahead by the time it slept.
    const elapsed = this.last === 0 ? 0 : Math.min(0.25, (now - this.last) / 1000);
    this.last = now;
    if (this.draw(elapsed)) this.request();
    else if (this.pending === 0) this.last = 0;
  }
}
