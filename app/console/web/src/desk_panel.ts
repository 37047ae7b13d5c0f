// SPDX-License-Identifier: Apache-2.0
// What is read from two metres: phase, standby, count-down, refusals. And the keys below it.

import { fact_text } from "./facts";
import { by_id, set_flag, set_text, show_if } from "./dom";
import type { Model } from "./model";
import type { Cue, State } from "./protocol";
import { clock_text, countdown_text } from "./time_text";
import { say, type Word } from "./words";

const kRefusedFor_ms = 4000;

/** What the card says of a state. Pure. */
export interface Card {
  phase: string; // for the style
  title: string;
  cue: string;
  standby: string;
  standby_name: string;
  left_s: number | undefined;
  left_to: string;
  notice: string;
  notes: string; // of the standby cue
  freeze: string; // what a HOLD would do, or did
  unsafe: boolean; // it says that people may touch
}

export function card_of(state: State, cues: Cue[]): Card {
  const find = (number: string | null) => cues.find((cue) => cue.number === number);
  const active = find(state.cue);
  // After a reset move the show is elsewhere.
  const resets = state.phase === "resets" || state.phase === "reset-held";
  const standby = resets ? cues.find((cue) => (state.reset.to_s ?? 0) < cue.to_s - 1e-3) : find(state.standby);
  const stands = state.phase === "stands";
  const held = stands && active !== undefined;
  const title: Record<string, Word> = { "counts-in": "counts_in", runs: "runs", resets: "resets", "reset-held": "reset_held", finished: "finished" };
  const card: Card = {
    phase: held ? "holds" : state.phase,
    title: held ? say("holds") : say(title[state.phase] ?? "stands"),
    cue: active && !resets ? say(held ? "in_cue" : "runs_cue", { number: active.number, name: active.name }) : "",
    standby: standby ? standby.number : state.phase === "finished" ? "" : say("the_end"),
    standby_name: standby ? standby.name : "",
    left_s: undefined,
    left_to: "",
    notice: notice_of(state, held ? active : undefined),
    notes: state.standby_notes ?? "",
    ...freeze_of(state, held),
  };
  if (state.goes_in_s !== null && (state.phase === "counts-in" || state.phase === "resets")) {
    card.left_s = state.goes_in_s;
    card.left_to = say("until_go", { cue: state.cue ?? state.standby ?? "" });
    if (state.phase === "resets") card.left_to = say("resets");
  } else if (state.phase === "runs" && state.ends_in_s !== null) {
    card.left_s = state.ends_in_s;
    card.left_to = say(!standby ? "until_end" : active && active.gap_after_s !== null ? "by_itself" : "until_next");
  }
  return card;
}

function waits(state: State): boolean {
  return state.phase === "stands" || state.phase === "finished";
}

/** What has to be done first, then what is set. */
function notice_of(state: State, held: Cue | undefined): string {
  const loop = state.loop ? say("loops", { from: clock_text(state.loop.from_s), to: clock_text(state.loop.to_s) }) : "";
  const muted = state.muted ? say("not_guided", { names: state.muted }) : "";
  return [to_do(state, held), loop, muted].filter(Boolean).join(" · ");
}

/** Before a HOLD what it would do, after it what going on would. */
function freeze_of(state: State, held: boolean): { freeze: string; unsafe: boolean } {
  const { freeze } = state;
  if (!freeze) return { freeze: "", unsafe: false };
  const many = (pairs: number) => say(pairs === 1 ? "one_pair" : "pairs", { n: pairs.toLocaleString("en") });
  if (held) return freeze.resume_pairs > 0 ? { freeze: say("resume_unsafe", { pairs: many(freeze.resume_pairs) }), unsafe: true } : { freeze: "", unsafe: false };
  if (state.phase !== "runs") return { freeze: "", unsafe: false };
  if (freeze.pairs === 0) return { freeze: say("freeze_safe"), unsafe: false };
  const until = freeze.until_count === null ? "" : say("freeze_until", { count: Math.ceil(freeze.until_count) });
  return { freeze: say("freeze_unsafe", { pairs: many(freeze.pairs), until }), unsafe: true };
}

function to_do(state: State, held: Cue | undefined): string {
  if (Array.isArray(state.against) && state.against.length > 0) return say(waits(state) && state.cue === null ? "not_ready" : "against", { names: state.against.map(fact_text).join(", ") });
  const stands = waits(state);
  const to = clock_text(state.reset.to_s ?? 0);
  if (stands && state.reset.state === "being-planned") return say("reset_planned");
  if (stands && state.reset.state === "impossible") return say("reset_impossible");
  if (stands && state.reset.state === "ready") {
    const here = Math.abs(state.position_s - (state.reset.from_s ?? 0)) < 1e-3;
    return say(here ? "reset_ready" : "reset_walks_on", { time: to });
  }
  if (state.phase === "resets") return say("reset_runs", { time: to });
  if (state.phase === "reset-held") return say("reset_goes_on", { time: to });
  if (state.holds_at_end) return say("holds_at_end");
  return held ? say("goes_on", { number: held.number }) : "";
}

export class DeskPanel {
  private refused_at_ms_ = -Infinity;

  constructor(private readonly model_: Model) {}

  /** A refused order, whoever gave it, is seen. */
  refuse(order: string, why: string): void {
    const part = by_id("refusal");
    part.classList.remove("shown");
    void part.offsetWidth; // begins the flash anew
    part.classList.add("shown");
    set_text(part, say("refused", { order: order || "GO", why }));
    this.refused_at_ms_ = performance.now();
  }

  draw(now_ms: number): void {
    if (now_ms - this.refused_at_ms_ > kRefusedFor_ms) {
      by_id("refusal").classList.remove("shown");
      set_text(by_id("refusal"), "");
    }
    const { state, show } = this.model_;
    if (!state || !show) {
      set_text(by_id("phase"), say("waiting"));
      return;
    }
    const card = card_of(state, show.cues);
    set_flag(by_id("card"), "data-phase", card.phase);
    set_text(by_id("phase"), card.title);
    set_text(by_id("cue_now"), card.cue);
    set_text(by_id("standby_number"), card.standby);
    set_text(by_id("standby_name"), card.standby_name);
    // Between two messages it counts down by itself.
    const since_s = (now_ms - this.model_.state_came_ms) / 1000;
    set_text(by_id("countdown"), card.left_s === undefined ? "" : countdown_text(card.left_s - since_s));
    set_text(by_id("left_to"), card.left_to);
    set_text(by_id("notice"), card.notice);
    set_flag(by_id("notice"), "title", card.notice || null);
    set_text(by_id("standby_notes"), card.notes);
    set_text(by_id("freeze"), card.freeze);
    by_id("freeze").classList.toggle("unsafe", card.unsafe);
    this.draw_keys(state);
  }

  private draw_keys(state: State): void {
    const asked = state.reset.state !== "none" && waits(state);
    show_if(by_id("placed"), asked);
    show_if(by_id("cancel"), asked);
    set_text(by_id("hold_end").children[0], say(state.holds_at_end ? "run_on" : "hold_end"));
    set_flag(by_id("hold_end"), "aria-pressed", String(state.holds_at_end));
    set_text(by_id("loop").children[0], say(state.loop ? "loop_off" : "loop"));
    set_flag(by_id("loop"), "aria-pressed", String(state.loop !== null));
  }
}
