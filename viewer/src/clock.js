// The one clock of the page: time of the run, whether it goes on, how fast.

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

export class Clock extends EventTarget {
  constructor(begin, end) {
    super();
    Object.assign(this, { begin, end, t: begin, playing: false, speed: 1 });
  }

  /** Moves on by the wall time that passed, which the first frame has too little of: it is stamped before it is asked for. At the end the clock stops. */
  advance(wallSeconds) {
    if (!this.playing) return;
    // A tab that was in the background must not jump ahead.
    this.t = Math.min(this.end, this.t + this.speed * Math.min(Math.max(wallSeconds, 0), 0.25));
    if (this.t >= this.end) this.play(false);
  }

  seek(t) {
    this.t = Math.min(this.end, Math.max(this.begin, t));
    this.dispatchEvent(new Event('seek'));
  }

  play(on) {
    if (on && this.t >= this.end) this.t = this.begin;
    this.playing = on && this.end > this.begin;
    this.dispatchEvent(new Event('play'));
  }

  toggle() { this.play(!this.playing); }

  restart() { this.seek(this.begin); this.play(true); }
}
