// SPDX-License-Identifier: Apache-2.0
// Groups, who of them is guided; who is absent; who has to be told of changed walks.

import { by_id, make, show_if } from "./dom";
import type { Model } from "./model";
import { say } from "./words";

const kMostUntold = 100; // rows; the figure tells of all

/** Whether the state names a group as one that is not guided. Pure. */
export function is_muted(muted: string | undefined, group: string): boolean {
  return (muted ?? "").split(", ").includes(group);
}

export class PeoplePanel {
  private drawn_ = "";

  constructor(private readonly model_: Model, private readonly order_: (order: string) => void, private readonly ask_: (prefix: string) => void, private readonly pick_: (id: string) => void) {}

  draw(): void {
    const { show, state, untold, role } = this.model_;
    if (!show || !state) return;
    const absent = state.edit?.absent ?? [];
    const now = JSON.stringify([show.epoch, show.groups, state.muted, absent, untold, role, document.documentElement.lang]);
    if (now === this.drawn_) return;
    this.drawn_ = now;
    by_id("groups").replaceChildren(...show.groups.map((group, i) => this.group_row(group, i)));
    show_if(by_id("groups_title"), show.groups.length > 0);
    show_if(by_id("unmute"), !!state.muted && role !== "view");
    by_id("absent").replaceChildren(...absent.map((one) => this.absent_row(one)));
    show_if(by_id("absent_title"), absent.length > 0);
    by_id("untold").replaceChildren(...untold.slice(0, kMostUntold).map((id) => this.untold_row(id)));
    if (untold.length > kMostUntold) by_id("untold").append(make("li", say("and_more", { n: (untold.length - kMostUntold).toLocaleString("en") })));
    by_id("untold_title").textContent = say("to_be_told", { n: untold.length.toLocaleString("en") });
    for (const part of ["untold_title", "told_all"]) show_if(by_id(part), untold.length > 0 && (part !== "told_all" || role !== "view"));
    // Seen on the tab, whichever is open.
    const many = absent.length + untold.length;
    by_id("people_many").textContent = many > 0 ? ` ${many.toLocaleString("en")}` : "";
  }

  private button(text: string, order: () => void): HTMLButtonElement {
    const button = make("button", text);
    button.addEventListener("click", order);
    return button;
  }

  private group_row(group: { name: string; colour: string }, index: number): HTMLElement {
    const muted = is_muted(this.model_.state?.muted, group.name);
    const row = make("li", "", muted ? "muted" : "");
    const sign = make("i", "", `sign pattern${index % 4}`);
    sign.style.backgroundColor = group.colour;
    row.append(sign, this.button(group.name, () => this.pick_(group.name)));
    if (this.model_.role === "view") return row;
    const mute = this.button(say("mute"), () => this.order_(`${muted ? "unmute" : "mute"} ${group.name}`));
    mute.setAttribute("aria-pressed", String(muted));
    row.append(this.button(say("solo"), () => this.order_(`solo ${group.name}`)), mute);
    return row;
  }

  private absent_row(one: { id: string; cover: string | null }): HTMLElement {
    const row = make("li");
    const how = one.cover === null ? say("place_empty") : one.cover === "repaired" ? say("repaired") : say("covered_by", { who: one.cover });
    row.append(this.button(one.id, () => this.pick_(one.id)), make("span", how));
    if (this.model_.role === "view") return row;
    if (one.cover === null) row.append(this.button(say("cover"), () => this.ask_(`cover ${one.id}`)), this.button(say("repair"), () => this.order_(`repair ${one.id}`)));
    row.append(this.button(say("present"), () => this.order_(`present ${one.id}`)));
    return row;
  }

  private untold_row(id: string): HTMLElement {
    const row = make("li");
    row.append(this.button(id, () => this.pick_(id)));
    if (this.model_.role !== "view") row.append(this.button(say("told"), () => this.order_(`told ${id}`)));
    return row;
  }
}
