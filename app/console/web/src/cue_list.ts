// SPDX-License-Identifier: Apache-2.0
// The cue list: what runs, what is on standby, and a choice by arrows from which to jump.

import { by_id, make, set_flag } from "./dom";
import type { Model } from "./model";
import { clock_text } from "./time_text";

export class CueList {
  private readonly list_ = by_id<HTMLOListElement>("cues");
  private rows_: HTMLLIElement[] = [];
  private chosen_ = -1;
  private followed_ = -2;

  constructor(private readonly model_: Model, private readonly jump_: (number: string) => void) {
    this.list_.addEventListener("dblclick", () => this.jump());
  }

  build(): void {
    const cues = this.model_.show?.cues ?? [];
    this.rows_ = cues.map((cue, i) => {
      const row = make("li");
      row.id = `cue_${i}`;
      row.setAttribute("role", "option");
      row.append(make("span", "", "state"), make("b", cue.number), make("span", cue.name), make("span", clock_text(cue.from_s), "when"));
      row.title = [cue.notes, cue.because].filter(Boolean).join("\n");
      row.addEventListener("click", () => this.choose(i));
      return row;
    });
    this.list_.replaceChildren(...this.rows_);
    this.chosen_ = -1;
    this.followed_ = -2;
  }

  /** One down or up from what is chosen; from the standby at first. */
  move(by: number): void {
    const from = this.chosen_ >= 0 ? this.chosen_ : this.model_.cue(this.model_.state?.standby ?? null);
    this.choose(Math.min(this.rows_.length - 1, Math.max(0, from + by)));
  }

  /** @return false: nothing was chosen */
  jump(): boolean {
    const cue = this.model_.show?.cues[this.chosen_];
    if (!cue) return false;
    this.choose(-1);
    this.jump_(cue.number);
    return true;
  }

  choose(row: number): void {
    this.chosen_ = row;
    this.rows_.forEach((one, i) => set_flag(one, "aria-selected", i === row ? "true" : null));
    set_flag(this.list_, "aria-activedescendant", row >= 0 ? `cue_${row}` : null);
    this.rows_[row]?.scrollIntoView({ block: "nearest" });
  }

  draw(): void {
    const { state } = this.model_;
    if (!state) return;
    const active = this.model_.cue(state.cue);
    const standby = this.model_.cue(state.standby);
    this.rows_.forEach((row, i) => {
      set_flag(row, "aria-current", i === active ? "true" : null);
      row.classList.toggle("standby", i === standby);
      row.classList.toggle("past", i < active || (active < 0 && standby >= 0 && i < standby));
      const mark = i === active ? (state.phase === "stands" ? "▮" : "▶") : i === standby ? "›" : "";
      if (row.children[0].textContent !== mark) row.children[0].textContent = mark;
    });
    const follow = active >= 0 ? active : standby;
    if (follow !== this.followed_ && this.chosen_ < 0) {
      this.rows_[follow]?.scrollIntoView({ block: "nearest" });
      this.followed_ = follow;
    }
  }
}
