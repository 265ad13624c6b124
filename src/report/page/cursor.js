// The one cursor in time: a clock of the run that is shown. Everything else follows it.

/** Seconds that the whole run takes at speed 1. */
const WHOLE = 12;

class Cursor {
  constructor() {
    this.clock = 0;
    this.radix = 'auto';
    this.speed = 1;
    this.followers = [];
  }

  /** Takes another run, at the same clock where it has it. */
  show(run) {
    this.run = run;
    this.clock = Math.max(run.first, Math.min(run.last, this.clock));
  }

  /** Moves to a clock, in the bounds of the run; `runs` where it goes on to others at once. */
  seek(clock, runs = false) {
    const to = Math.max(this.run.first, Math.min(this.run.last, Math.round(clock)));
    if (!Number.isFinite(to) || to === this.clock) return;
    this.clock = to;
    this.runs = runs;
    this.follow();
  }

  /** Lets all follow in the next frame, however often the cursor moves before it. */
  follow() {
    this.waiting ??= requestAnimationFrame(() => {
      this.waiting = undefined;
      this.followers.forEach((follower) => follower());
    });
  }

  /** The next of ascending clocks, or the one before. */
  among(clocks, by) {
    const at = lastUpTo(clocks, by > 0 ? this.clock : this.clock - 1) + (by > 0 ? 1 : 0);
    if (at >= 0 && at < clocks.length) this.seek(clocks[at]);
    else this.seek(by > 0 ? this.run.last : this.run.first);
  }

  step(by) {
    if (this.run.steps?.clocks.length) this.among(this.run.steps.clocks, by);
  }

  block(by) {
    this.among(this.run.starts, by);
  }

  get isPlaying() {
    return this.frame !== undefined;
  }

  /** Plays on from here, or from the start where it is at the end. */
  play() {
    if (this.isPlaying) {
      cancelAnimationFrame(this.frame);
      this.frame = undefined;
      this.follow();
      return;
    }
    if (this.clock >= this.run.last) this.seek(this.run.first);
    const rate = Math.max(4, (this.run.last - this.run.first) / WHOLE);
    let before, exact = this.clock;
    const go = (now) => {
      exact += rate * this.speed * Math.min(0.1, (now - (before ?? now)) / 1000);
      before = now;
      if (Math.abs(exact - this.clock) > Math.max(2, rate)) exact = this.clock;
      if (exact >= this.run.last) {
        this.frame = undefined;
        this.clock = -1;
        this.seek(this.run.last);
        return;
      }
      this.frame = requestAnimationFrame(go);
      this.seek(Math.floor(exact), true);
    };
    this.frame = requestAnimationFrame(go);
    this.follow();
  }
}
