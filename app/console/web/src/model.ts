// SPDX-License-Identifier: Apache-2.0
// All that the page knows of the run. The panels read it; main.ts alone writes it.

import { Layers, Nodes, switch_at } from "./floor_state";
import { type Alarm, type BusHealth, kChannels, type RunEvent, type Show, type State } from "./protocol";
import { ShowClock } from "./show_clock";
import type { Tracks } from "./tracks";

export interface Person {
  id: number;
  name: string;
  role: string;
}

export class Model {
  show?: Show;
  tracks?: Tracks;
  centres: Float32Array = new Float32Array();
  state?: State;
  readonly clock = new ShowClock();
  state_came_ms = 0;
  readonly nodes = new Nodes();
  readonly layers = new Layers();
  /** The reset move, while there is one. */
  way?: Tracks;
  readonly way_clock = new ShowClock();

  me = 0;
  role = "view";
  holder: { id: number; name: string } | null = null;
  people: Person[] = [];
  alarms: Alarm[] = [];
  log: RunEvent[] = [];
  health: BusHealth[] = [];

  /** Looked at instead of now, s. */
  scrub_s: number | undefined;
  selected = -1; // performer
  /** More than one: a range or a group, picked together. */
  marked: readonly number[] = [];
  /** Ids of people whose walks have changed and who have not been told. */
  untold: readonly string[] = [];
  private switch_times_: number[] = [];

  take_show(show: Show, tracks: Tracks, centres: Float32Array): void {
    this.show = show;
    this.tracks = tracks;
    this.centres = centres;
    this.nodes.fit(show.rig.length);
    this.layers.clear();
    this.switch_times_ = show.switch_at.map((one) => one.time_s);
    if (this.selected >= show.performers.length) this.selected = -1;
    this.marked = this.marked.filter((one) => one < show.performers.length);
  }

  take_state(state: State, now_ms: number): void {
    this.state = state;
    this.state_came_ms = now_ms;
    const runs = state.phase === "runs";
    const rate = typeof state.rate === "number" ? state.rate : runs ? state.tempo_percent / 100 : 0;
    const resets = state.phase === "resets";
    this.clock.tell({ position_s: state.position_s, rate: resets ? 0 : rate, came_ms: now_ms });
  }

  /** Stages before the first GO; a program that knows none arms it. */
  readiness(): { scope?: string; armed: boolean; stages: { name?: string; state?: string; text?: string }[] } {
    const told = this.state?.readiness;
    if (typeof told !== "object" || told === null) return { armed: true, stages: [] };
    const { scope, armed, stages } = told as { scope?: unknown; armed?: unknown; stages?: unknown };
    return { scope: typeof scope === "string" ? scope : undefined, armed: armed !== false, stages: Array.isArray(stages) ? stages : [] };
  }

  /** Somebody has said GO, or the run was taken up in the midst of the show. */
  begun(): boolean {
    const { state, show } = this;
    return state !== undefined && (state.cue !== null || state.phase !== "stands" || state.position_s > (show?.cues[0]?.from_s ?? 0) + 1e-3);
  }

  leads(): boolean {
    return this.holder !== null && this.holder.id === this.me;
  }

  /** What is looked at: now, or the instant of the timeline. s */
  shown_s(now_ms: number): number {
    return this.scrub_s ?? this.clock.at(now_ms);
  }

  /** The switch that the plan wants at an instant; -1: none. */
  planned_switch(time_s: number): number {
    return switch_at(this.switch_times_, time_s);
  }

  cue(number: string | null): number {
    return number === null || !this.show ? -1 : this.show.cues.findIndex((cue) => cue.number === number);
  }

  /** The next picture that people make: its first formation after an instant, s; undefined behind the last. */
  next_formation_s(time_s: number): number | undefined {
    return this.show?.formations.find((one) => one.key && one.time_s > time_s + 0.01)?.time_s;
  }

  /** Index of the channel that is a performer's wearable or lies on a cell; -1: none. */
  channel_of(what: number): number {
    const rig = this.show?.rig ?? [];
    for (let node = 0; node < rig.length; ++node) {
      const channel = rig[node].channels.indexOf(what);
      if (channel >= 0) return node * kChannels + channel;
    }
    return -1;
  }
}
