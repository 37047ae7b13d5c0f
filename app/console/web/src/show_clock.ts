// SPDX-License-Identifier: Apache-2.0
// Where the show is between two messages. Pure.

/** What the program said last, and when it came. Rate is show seconds a second: 0 while the show stands. */
export interface Told {
  position_s: number;
  rate: number;
  came_ms: number; // of the page's clock
}

const kJump_s = 0.25; // a larger difference is no jitter
const kCatchUp_s = 0.5; // in which jitter is worked off

/**
 * A clock that follows what is told without stuttering: small differences, which are the network's, are worked off; a
 * show that stands or jumps is shown at once where it is.
 */
export class ShowClock {
  private told_: Told = { position_s: 0, rate: 0, came_ms: 0 };
  private error_s_ = 0; // of what was shown when the last message came

  tell(told: Told): void {
    const shown = this.at(told.came_ms);
    const error = shown - told.position_s;
    const continuous = told.rate !== 0 && this.told_.rate !== 0 && Math.abs(error) < kJump_s;
    this.error_s_ = continuous ? error : 0;
    this.told_ = told;
  }

  /** Position of the show, s. */
  at(now_ms: number): number {
    const since_s = Math.max(0, now_ms - this.told_.came_ms) / 1000;
    const left = this.error_s_ * Math.max(0, 1 - since_s / kCatchUp_s);
    return this.told_.position_s + this.told_.rate * since_s + left;
  }

  runs(): boolean {
    return this.told_.rate !== 0;
  }
}
