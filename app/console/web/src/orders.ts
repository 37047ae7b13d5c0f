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

export class Orders {
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

  tempo(by_percent: number): void {
    const percent = (this.model_.state?.tempo_percent ?? 100) + by_percent;
    this.say(`tempo ${Math.min(kFastest_percent, Math.max(kSlowest_percent, percent))}`);
  }

  /** Of a key or button whose meaning depends on the state. */
  named(order: string): void {
    const { state } = this.model_;
    if (order === "hold_end") this.say(state?.holds_at_end ? "run on" : "hold end");
    else if (order === "loop" && state?.loop) this.say("loop off");
    else if (order === "loop") this.ask("loop ");
    else if (order === "faster" || order === "slower") this.tempo(order === "faster" ? kTempoStep_percent : -kTempoStep_percent);
    else this.say(order);
  }
}
