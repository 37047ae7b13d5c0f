// SPDX-License-Identifier: Apache-2.0
// What is said at this desk, in the words of docs/live.md.

import type { DeskPanel } from "./desk_panel";
import { by_id } from "./dom";
import type { Link } from "./link";
import type { Model } from "./model";
import { say } from "./words";

const kSlowest_percent = 25;
const kFastest_percent = 200;
const kTempoStep_percent = 5;

const kUntilTold_ms = 1000; // in which the program answers

export class Orders {
  private wanted_percent_ = 0;
  private wanted_at_ms_ = -Infinity;

  constructor(private readonly model_: Model, private readonly link_: Link, private readonly desk_: DeskPanel) {}

  /** HOLD needs no seat; what cannot be sent is refused where it was said. */
  say(order: string): void {
    if (order !== "hold" && !this.model_.leads()) this.desk_.refuse(order, say("seat_needed"));
    else if (!this.link_.say({ order })) this.desk_.refuse(order, say("no_link"));
  }

  /** Somebody types the rest. */
  ask(prefix: string): void {
    const field = by_id<HTMLInputElement>("order");
    field.value = prefix;
    field.focus();
  }

  /** Several presses add up, also before the program has answered the first. */
  tempo(by_percent: number): void {
    const now = performance.now();
    const told = this.model_.state?.tempo_percent ?? 100;
    const from = now - this.wanted_at_ms_ < kUntilTold_ms ? this.wanted_percent_ : told;
    this.wanted_percent_ = Math.min(kFastest_percent, Math.max(kSlowest_percent, from + by_percent));
    this.wanted_at_ms_ = now;
    this.say(`tempo ${this.wanted_percent_}`);
  }

  /** Of a key or button whose meaning depends on the state. */
  named(order: string): void {
    const { state } = this.model_;
    if (order === "hold_end") this.say(state?.holds_at_end ? "run on" : "hold end");
    else if (order === "loop" && state?.loop) this.say("loop off");
    else if (order === "loop") this.ask("loop ");
    else if ((order === "mute" || order === "solo") && state?.muted) this.say("unmute");
    else if (order === "mute" || order === "solo") this.ask(`${order} `);
    else if (order === "faster" || order === "slower") this.tempo(order === "faster" ? kTempoStep_percent : -kTempoStep_percent);
    else this.say(order);
  }
}
