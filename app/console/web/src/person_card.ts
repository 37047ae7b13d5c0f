// SPDX-License-Identifier: Apache-2.0
// Who was picked: place, next place, markers.

import { cell_name } from "./cell_name";
import { by_id, set_facts, set_text, show_if } from "./dom";
import type { Looks } from "./looks";
import type { Model } from "./model";
import { kChannels, kNothing, type Show } from "./protocol";
import { mark_before, next_place } from "./tracks";
import { say } from "./words";

export function draw_person(model: Model, looks: Looks, now_ms: number): void {
  const { show, tracks, selected, marked } = model;
  const one = show?.performers[selected];
  show_if(by_id("person"), one !== undefined || marked.length > 0);
  show_if(by_id("person_orders"), one !== undefined && model.role !== "view");
  if (!show || !tracks) return;
  if (!one) return draw_many(show, marked);
  const away = model.state?.edit?.absent.some((who) => who.id === one.id) ?? false;
  for (const order of ["absent"]) show_if(by_id(`person_${order}`), !away);
  for (const order of ["present", "repair", "cover"]) show_if(by_id(`person_${order}`), away);
  const name = one.name && one.name !== one.id ? `${one.id} ${one.name}` : one.id;
  set_text(by_id("person_name"), name + (one.absent || away ? ` (${say("absent")})` : ""));
  const time_ms = model.shown_s(now_ms) * 1000;
  const cell = tracks.marks[2 * mark_before(tracks, selected, time_ms) + 1];
  const next = next_place(tracks, selected, time_ms);
  const columns = show.stage.columns;
  const facts: [string, string][] = [];
  if (one.group !== null) facts.push([say("group"), show.groups[one.group]?.name ?? ""]);
  facts.push([say("cell"), cell_name(cell, columns)]);
  const seconds = next ? Math.max(0, (next.time_ms - time_ms) / 1000).toFixed(0) : "";
  facts.push([say("next_place"), next ? say("in_seconds", { cell: cell_name(next.cell, columns), seconds }) : say("stays")]);
  const markers = [model.channel_of(cell), model.channel_of(-1 - selected)].filter((channel) => channel >= 0);
  for (const channel of markers) facts.push([say("marker"), marker_text(model, looks, channel)]);
  set_facts(by_id("person_facts"), facts);
}

/** A range or a group: how many, and of which groups. */
function draw_many(show: Show, marked: readonly number[]): void {
  if (marked.length === 0) return;
  set_text(by_id("person_name"), say("many_people", { n: marked.length.toLocaleString("en") }));
  const of_groups = new Map<string, number>();
  for (const one of marked) {
    const group = show.performers[one].group;
    const name = group === null ? "–" : show.groups[group]?.name ?? "–";
    of_groups.set(name, (of_groups.get(name) ?? 0) + 1);
  }
  const names = [...of_groups].map(([name, n]) => `${name} ${n.toLocaleString("en")}`).join(", ");
  const ends = `${show.performers[marked[0]].id} – ${show.performers[marked[marked.length - 1]].id}`;
  set_facts(by_id("person_facts"), [[say("many_from_to"), ends], [say("group"), names]]);
}

/** "n3.4: #FFB000 steady" */
function marker_text(model: Model, looks: Looks, channel: number): string {
  const show = model.show;
  const node = Math.floor(channel / kChannels);
  const name = `${show?.rig[node].name}.${channel % kChannels}`;
  const index = model.nodes.index[node];
  const look = index === kNothing ? undefined : looks.look(index, channel);
  if (look === undefined) return `${name}: –`;
  const entry = show?.looks[look];
  const problem = model.nodes.drawn_state(node) !== 0 ? "☒ " : "";
  return `${problem}${name}: ${entry && entry.brightness > 0 ? `${entry.colour} ${entry.effect}` : "dark"}`;
}
