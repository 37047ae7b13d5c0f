// SPDX-License-Identifier: Apache-2.0
// Fetches the show, and makes of it what the GPU takes.

import { kNoGroup } from "./look_table";
import { centres_of, decode_plan, kChannels, type Show } from "./protocol";
import type { Scene } from "./scene";
import type { Tracks } from "./tracks";

export class Unauthorised extends Error {}

export class Program {
  token: string | undefined;

  private headers(): Record<string, string> {
    return this.token ? { Authorization: `Bearer ${this.token}` } : {};
  }

  private async get(path: string): Promise<Response> {
    const answer = await fetch(path, { headers: this.headers(), cache: "no-store" });
    if (answer.status === 401) throw new Unauthorised(path);
    return answer;
  }

  /** @return undefined: there is none such */
  async bytes(path: string): Promise<ArrayBuffer | undefined> {
    const answer = await this.get(path);
    if (answer.status === 404) return undefined;
    if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
    return answer.arrayBuffer();
  }

  /** Show and plan of one epoch. */
  async show(): Promise<{ show: Show; tracks: Tracks; centres: Float32Array }> {
    for (let tries = 0; ; ++tries) {
      const answer = await this.get("api/show");
      if (!answer.ok) throw new Error(`api/show: ${answer.status}`);
      const show = (await answer.json()) as Show;
      const bytes = await this.bytes("api/plan.bin");
      if (!bytes) throw new Error("api/plan.bin: there is none");
      const plan = decode_plan(bytes, show.stage.columns * show.stage.rows);
      if (plan.epoch === show.epoch) {
        if (plan.tracks.starts.length - 1 !== show.performers.length) throw new Error("plan.bin is of other people than the show");
        return { show, tracks: plan.tracks, centres: centres_of(show.stage) };
      }
      if (tries > 3) throw new Error("the show changes faster than it can be fetched");
    }
  }

  /** @return a token, or why there is none */
  async pair(code: string): Promise<{ token?: string; error?: string }> {
    const answer = await fetch("api/pair", {
      method: "POST",
      headers: { "Content-Type": "application/json", "X-Footlight": "1" },
      body: JSON.stringify({ code }),
    });
    const body = (await answer.json()) as { token?: string; error?: string };
    return answer.ok ? body : { error: body.error ?? String(answer.status) };
  }
}

const kBlocked = 1;
const kWing = 2;
const kDownstage = 128; // a triangle that points so
const kSelected = 1;
const kAbsent = 2;

export function flags_of(show: Show, performer: number, selected: boolean): number {
  return (selected ? kSelected : 0) | (show.performers[performer]?.absent ? kAbsent : 0);
}

export function colour_of(show: Show, performer: number): number {
  return Math.min(kNoGroup, show.performers[performer]?.group ?? kNoGroup);
}

/** @param picked who was picked */
export function send_show(scene: Scene, show: Show, tracks: Tracks, centres: Float32Array, picked: readonly number[]): void {
  const { columns, rows, blocked, wings, grid } = show.stage;
  const cells = new Uint8Array(columns * rows);
  for (const cell of wings) cells[cell] = kWing;
  for (const cell of blocked) cells[cell] = kBlocked;
  if (grid === "triangular") {
    for (let cell = 0; cell < cells.length; ++cell) if (((cell % columns) + Math.floor(cell / columns)) % 2 === 1) cells[cell] |= kDownstage;
  }
  const lamps: number[] = [];
  show.rig.forEach((node, n) => node.channels.forEach((what, channel) => {
    if (what !== null && what >= 0) lamps.push(what, kChannels * n + channel);
  }));
  const who = new Uint8Array(2 * show.performers.length);
  const chosen = new Set(picked);
  for (let p = 0; p < show.performers.length; ++p) {
    who[2 * p] = colour_of(show, p);
    who[2 * p + 1] = flags_of(show, p, chosen.has(p));
  }
  scene.take_show(show, centres, tracks, cells, new Uint32Array(lamps), who);
}
