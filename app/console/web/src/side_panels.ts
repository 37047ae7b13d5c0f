// SPDX-License-Identifier: Apache-2.0
// Beside the stage: health of buses and nodes, who is connected, the log; above it: alarms and readiness.

import { fact_text, is_empty } from "./facts";
import { by_id, make, set_facts, set_flag, set_text, show_if } from "./dom";
import type { Model } from "./model";
import { kNothing, kQuarantined, kRight, kSilent, kUnverified, type RunEvent } from "./protocol";
import { is_word, say } from "./words";

const kOfNodes = new Set(["roll-call", "plan-on-nodes", "looks"]);
const kMostListed = 200;
const kMostLogged = 500;
/** What has a place of its own on the page; anything else that a state tells is listed by its name. */
const kKnownFacts = new Set(["phase", "position_s", "rate", "section", "measure", "count", "cue", "standby", "goes_in_s", "ends_in_s", "tempo_percent",
  "most_percent", "most_because", "holds_at_end", "loop", "reset", "switch", "ready", "buses", "readiness", "time", "scope", "next_switch", "against",
  "standby_notes", "freeze", "muted", "edit", "swap", "question"]);

function time_of(unix_ms: number): string {
  return new Date(unix_ms).toLocaleTimeString("en-GB");
}

export class SidePanels {
  private logged_ = 0;

  constructor(private readonly model_: Model, private readonly acknowledge_: (n: number) => void, private readonly order_: (order: string) => void) {
    const tabs = ["health", "find", "log"];
    for (const name of tabs) by_id(`tab_${name}`).addEventListener("click", () => this.open(name));
  }

  open(name: string): void {
    for (const one of ["health", "find", "log"]) {
      show_if(by_id(one), one === name);
      by_id(`tab_${one}`).setAttribute("aria-selected", String(one === name));
    }
  }

  draw_alarms(): void {
    const open = this.model_.alarms.filter((alarm) => alarm.acknowledged_by === null);
    // One line for the newest: what leads the show must not be pushed out of sight.
    by_id("alarms").replaceChildren(...open.slice(-1).map((alarm) => {
      const row = make("div");
      const seen = make("button", say("seen"));
      seen.addEventListener("click", () => this.acknowledge_(alarm.n));
      row.append(make("b", `⚠ ${time_of(alarm.unix_ms)}`), make("span", alarm.text), seen);
      if (open.length === 1) return row;
      const all = make("button", say("all_seen", { n: open.length }));
      all.addEventListener("click", () => open.forEach((one) => this.acknowledge_(one.n)));
      row.append(all);
      return row;
    }));
  }

  /** All of them before the show has begun; then what is not as it should be. */
  draw_stages(): void {
    const { stages: all, armed } = this.model_.readiness();
    const done = (state: string) => state === "SUCCESS" || state === "SKIPPED";
    const begun = armed && this.model_.begun();
    // What nodes answer is told by health and alarms from then on.
    const stages = begun ? all.filter((stage) => !done(String(stage.state)) && !kOfNodes.has(String(stage.name))) : all;
    const part = by_id("stages");
    show_if(part, stages.length > 0);
    const now = JSON.stringify([stages, armed, this.model_.role, document.documentElement.lang]);
    if (part.dataset.now === now) return;
    part.dataset.now = now;
    const signs: Record<string, string> = { success: "✓", error: "✗", warning: "!", waiting: "…", next: "›", skipped: "–", off: "·" };
    part.replaceChildren(...stages.map((stage) => {
      const state = String(stage.state ?? "").toLowerCase();
      const one = make("span", `${signs[state] ?? "?"} ${stage.name ?? ""}: ${String(stage.state ?? "")}${stage.text && state !== "success" ? ` (${stage.text})` : ""}`);
      if (/^[a-z]+$/.test(state)) one.className = state;
      one.setAttribute("role", "listitem");
      if (state !== "error" || this.model_.role === "view") return one;
      const answer = make("button", say("override"));
      answer.addEventListener("click", () => this.order_(`override ${stage.name ?? ""}`));
      one.append(answer);
      return one;
    }));
    if (armed || stages.length === 0 || this.model_.role === "view") return;
    const arm = make("button", say("arm"));
    arm.disabled = all.some((stage) => !["SUCCESS", "SKIPPED", "WARNING"].includes(String(stage.state)));
    arm.addEventListener("click", () => this.order_("arm"));
    part.append(arm);
  }

  draw_health(): void {
    const { show, state } = this.model_;
    if (!show || !state) return;
    const figures = this.model_.nodes.figures();
    const bad = figures.wrong + figures.silent + figures.quarantined;
    const words = by_id("floor_words");
    words.classList.toggle("wrong", bad > 0 && state.ready);
    set_text(words, this.floor_words(bad, figures.unverified));
    this.draw_buses();
    this.draw_wrong_nodes();
    const rest = Object.entries(state).filter(([name, value]) => !kKnownFacts.has(name) && !is_empty(value));
    show_if(by_id("more_title"), rest.length > 0);
    set_facts(by_id("more"), rest.map(([name, value]) => [is_word(name) ? say(name) : name.replace(/_/g, " "), fact_text(value)]));
    const { scope, armed } = this.model_.readiness();
    show_if(by_id("scope"), scope !== undefined);
    set_text(by_id("scope"), [say("scope", { scope: scope ?? "" }), armed ? "" : say("not_armed")].filter(Boolean).join(" · "));
  }

  /** "12 of 3,290 markers not right: n1 (left 3), ..." */
  private floor_words(bad: number, unverified: number): string {
    const { show, nodes } = this.model_;
    if (!show || show.rig.length === 0) return say("no_rig");
    if (this.model_.state?.ready === false) return say("being_asked");
    if (bad === 0) return unverified > 0 ? say("unverified", { n: unverified }) : say("all_right", { n: nodes.many });
    let markers = 0;
    const names: string[] = [];
    nodes.flags.forEach((flags, node) => {
      if ((flags & (kSilent | kQuarantined)) === 0 && (flags & (kRight | kUnverified)) !== 0) return;
      markers += show.rig[node].channels.filter((channel) => channel !== null).length;
      if (names.length < 5) names.push(show.rig[node].name);
    });
    const list = names.join(", ") + (bad > names.length ? ` ${say("and_more", { n: bad - names.length })}` : "");
    return say("some_wrong", { n: markers.toLocaleString("en"), all: show.markers.toLocaleString("en"), list });
  }

  private draw_buses(): void {
    const { state, health } = this.model_;
    const rows: string[][] = (state?.buses ?? []).map((bus) => {
      const more = health.find((one) => one.name === bus.name);
      return [bus.name, `${bus.nodes - bus.unconfirmed}/${bus.nodes}`, more ? `${more.worst_lateness_ms.toFixed(1)} ms` : "", more ? String(more.retries) : "", bus.trouble ?? ""];
    });
    const body = by_id("buses");
    const now = JSON.stringify(rows);
    if (body.dataset.now === now) return;
    body.dataset.now = now;
    body.replaceChildren(...rows.flatMap(([name, right, late, retries, trouble]) => {
      const row = make("tr");
      const [a, b] = right.split("/");
      if ((a !== b && state?.ready !== false) || trouble) row.className = "wrong";
      row.append(make("td", (row.className ? "☒ " : "") + name), make("td", right), make("td", late), make("td", retries));
      if (!trouble) return [row];
      const more = make("tr", "", "wrong");
      const cell = make("td", trouble, "trouble");
      cell.colSpan = 4;
      more.append(cell);
      return [row, more];
    }));
  }

  private draw_wrong_nodes(): void {
    const { show, nodes } = this.model_;
    if (!show || this.model_.state?.ready === false) return;
    const lines: { name: string; text: string }[] = [];
    nodes.flags.forEach((flags, node) => {
      const bad = (flags & (kSilent | kQuarantined)) !== 0 || (flags & (kRight | kUnverified)) === 0;
      if (!bad) return;
      const one = show.rig[node];
      const how = say(flags & kQuarantined ? "node_quarantined" : flags & kSilent ? "node_silent" : "node_wrong");
      const last = nodes.index[node] === kNothing ? "–" : nodes.index[node];
      lines.push({ name: one.name, text: `${show.buses[one.bus]?.name ?? "?"} ${one.address} · ${how} · ${say("node_last", { last })} · ${say("node_markers", { n: one.channels.filter((c) => c !== null).length })}` });
    });
    show_if(by_id("wrong_title"), lines.length > 0);
    const list = by_id("wrong_nodes");
    const now = JSON.stringify([lines, this.model_.role]);
    if (list.dataset.now === now) return;
    list.dataset.now = now;
    list.replaceChildren(...lines.slice(0, kMostListed).map(({ name, text }) => {
      const row = make("li");
      row.append(make("b", name), make("span", text));
      if (this.model_.role === "view") return row;
      const swap = make("button", say("swap"));
      swap.addEventListener("click", () => this.order_(`swap ${name}`));
      row.append(swap);
      return row;
    }));
    if (lines.length > kMostListed) list.append(make("li", say("and_more", { n: lines.length - kMostListed })));
  }

  draw_people(): void {
    const { people, holder, me, role } = this.model_;
    by_id("connected").replaceChildren(...people.map((one) => make("li", `${one.name}${one.id === me ? " ←" : ""} · ${one.role}${one.id === holder?.id ? " ★" : ""}`)));
    const seat = by_id("seat");
    seat.classList.toggle("mine", this.model_.leads());
    set_text(seat, role === "view" ? say("view_only") : this.model_.leads() ? say("seat_mine") : holder ? say("seat_other", { name: holder.name }) : say("seat_empty"));
    const take = by_id("take_seat");
    show_if(take, role !== "view");
    set_text(take, say(this.model_.leads() ? "leave_seat" : "take_seat"));
    show_if(by_id("pairing"), role === "admin");
  }

  /** Newest first. */
  log(event: RunEvent): void {
    const text = event.answer ? `${event.answer.order || "go"} (${event.answer.who}): ${event.answer.text}` : event.alarm ?? event.reset ?? event.note ?? event.moment ?? "";
    if (!text) return;
    const row = make("li", "", event.alarm ? "alarm" : event.answer?.refused ? "refused" : "");
    row.append(make("time", time_of(event.unix_ms)), make("span", (event.alarm ? "⚠ " : event.answer?.refused ? "✗ " : "") + text));
    const list = by_id("log");
    list.prepend(row);
    if (++this.logged_ > kMostLogged) list.lastElementChild?.remove();
  }

  draw_link(round_trip_ms: number | undefined, connected: boolean): void {
    set_text(by_id("link"), !connected ? say("connecting") : round_trip_ms === undefined ? "" : say("link", { ms: Math.round(round_trip_ms) }));
    set_flag(document.body, "data-connected", String(connected));
  }
}
