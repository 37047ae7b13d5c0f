// SPDX-License-Identifier: Apache-2.0
// Who was picked: place, next place, markers.

import { cell_name } from "./cell_name";
import { by_id, set_facts, set_text, show_if } from "./dom";
import type { Looks } from "./looks";
import type { Model } from "./model";
import { kChannels, kNothing } from "./protocol";
import { mark_before, next_place } from "./tracks";
import { say } from "./words";

export function draw_person(model: Model, looks: Looks, now_ms: number): void {
  const { show, tracks, selected } = model;
  const one = show?.performers[selected];
  show_if(by_id("person"), one !== undefined);
  if (!show || !tracks || !one) return;
  const name = one.name && one.name !== one.id ? `${one.id} ${one.name}` : one.id;
  set_text(by_id("person_name"), name + (one.absent ? ` (${say("absent")})` : ""));
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
