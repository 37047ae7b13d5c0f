// SPDX-License-Identifier: Apache-2.0
// Fetches the looks of the switches that are shown or come next, and keeps what nodes show on the GPU.

import { kNoLayer } from "./floor_state";
import type { Model } from "./model";
import { decode_looks, kNothing } from "./protocol";
import type { Scene } from "./scene";

export type Fetch = (path: string) => Promise<ArrayBuffer | undefined>;

const kAhead = 2; // switches fetched before they are lit
const kTries = 3;

export class Looks {
  private readonly asked_ = new Map<number, number>(); // tries
  private readonly bytes_ = new Map<number, Uint8Array>();
  private readonly blinking_ = new Set<number>(); // switches at which some lamp is not steady
  private changed_ = true;

  constructor(private readonly model_: Model, private readonly scene_: () => Scene | undefined, private readonly fetch_: Fetch) {}

  clear(): void {
    this.asked_.clear();
    this.bytes_.clear();
    this.blinking_.clear();
    this.changed_ = true;
  }

  /** Whether some lamp that is shown is not steady, by the switches that nodes have confirmed or that is looked at. */
  blink(): boolean {
    if (this.blinking_.size === 0) return false;
    const { nodes, scrub_s } = this.model_;
    if (scrub_s !== undefined) return this.blinking_.has(Math.max(0, this.model_.planned_switch(scrub_s)));
    for (const index of nodes.switches()) if (this.blinking_.has(index)) return true;
    return false;
  }

  nodes_changed(): void {
    this.changed_ = true;
  }

  /** What a channel shows by the looks of a switch; undefined: not here. */
  look(index: number, channel: number): number | undefined {
    return this.bytes_.get(index)?.[channel];
  }

  /** Before each frame. @return layer of the scrubbed switch, -1: none */
  prepare(): number {
    const { model_: model } = this;
    if (!model.show || model.show.rig.length === 0) return -1;
    const used = model.nodes.switches();
    const planned = model.scrub_s === undefined ? -1 : Math.max(0, model.planned_switch(model.scrub_s));
    const next = Number(model.state?.next_switch ?? (model.state?.switch ?? -1) + 1);
    if (planned >= 0) used.add(planned);
    for (const index of used) this.want(index, used);
    for (let k = 0; k < kAhead; ++k) if (next + k >= 0 && next + k < model.show.switches) this.want(next + k, used);
    if (this.changed_) this.send_nodes();
    return planned >= 0 ? model.layers.find(planned) ?? -1 : -1;
  }

  private want(index: number, used: ReadonlySet<number>): void {
    if (this.model_.layers.find(index) !== undefined) return;
    const tries = this.asked_.get(index) ?? 0;
    if (tries >= kTries) return;
    this.asked_.set(index, Infinity); // one at a time
    const epoch = this.model_.show?.epoch;
    void this.fetch_(`api/looks/${index}.bin`).then((bytes) => {
      this.asked_.set(index, bytes ? 0 : tries + 1);
      if (!bytes || this.model_.show?.epoch !== epoch) return;
      const decoded = decode_looks(bytes);
      const layer = this.model_.layers.take(index, used);
      if (layer === undefined) return;
      this.bytes_.set(index, decoded.looks);
      const effects = (this.model_.show?.looks ?? []).map((look) => look.effect !== "steady" && look.brightness > 0);
      if (decoded.looks.some((look) => effects[look])) this.blinking_.add(index);
      else this.blinking_.delete(index);
      this.scene_()?.take_looks(layer, decoded.looks);
      this.changed_ = true;
      this.forget();
    }, () => this.asked_.set(index, tries + 1));
  }

  private forget(): void {
    for (const index of this.bytes_.keys()) if (this.model_.layers.peek(index) === undefined) this.bytes_.delete(index);
  }

  private send_nodes(): void {
    const { nodes, layers } = this.model_;
    const state = new Uint8Array(2 * nodes.many);
    const asked = this.model_.state?.ready !== false;
    for (let node = 0; node < nodes.many; ++node) {
      const index = nodes.index[node];
      state[2 * node] = index === kNothing ? kNoLayer : layers.peek(index) ?? kNoLayer;
      // Before the roll call is over nobody is missing yet.
      state[2 * node + 1] = asked ? nodes.drawn_state(node) : 0;
    }
    this.scene_()?.take_nodes(state);
    this.changed_ = false;
  }
}
