// SPDX-License-Identifier: Apache-2.0
// What every node was last confirmed to show, and which switches' looks the GPU keeps for that. Pure.

import { kNothing, kQuarantined, kRight, kSilent, kUnverified, type NodeRun } from "./protocol";

export const kLayers = 32; // switches whose looks are kept
export const kNoLayer = 255;

/** State of a lamp as it is drawn. */
export const kDrawnSilent = 1;
export const kDrawnWrong = 2;

/** Which switch lies in which layer; the one that was not asked for longest makes room. */
export class Layers {
  private readonly layer_of_ = new Map<number, number>(); // in the order of use

  /** @return the layer of a switch; undefined: its looks are not here */
  find(index: number): number | undefined {
    const layer = this.layer_of_.get(index);
    if (layer === undefined) return undefined;
    this.layer_of_.delete(index);
    this.layer_of_.set(index, layer);
    return layer;
  }

  /** As `find`, but it does not count as use. */
  peek(index: number): number | undefined {
    return this.layer_of_.get(index);
  }

  /** @param used switches that must stay  @return a layer to write to; undefined: all are used */
  take(index: number, used: ReadonlySet<number>): number | undefined {
    const known = this.find(index);
    if (known !== undefined) return known;
    let layer: number | undefined = this.layer_of_.size;
    if (layer >= kLayers) {
      const old = [...this.layer_of_.keys()].find((one) => !used.has(one));
      if (old === undefined) return undefined;
      layer = this.layer_of_.get(old) as number;
      this.layer_of_.delete(old);
    }
    this.layer_of_.set(index, layer);
    return layer;
  }

  clear(): void {
    this.layer_of_.clear();
  }
}

const kMostNodes = 1 << 20;

/** The nodes of the rig as last told. */
export class Nodes {
  index = new Uint32Array(); // of the switch
  flags = new Uint8Array();
  private of_a_show_ = false;

  /** @param many none: nobody knows the rig yet, and it grows with what is told */
  constructor(many?: number) {
    if (many !== undefined) this.fit(many);
  }

  get many(): number {
    return this.flags.length;
  }

  /** The rig has so many; what was told of them stays. */
  fit(many: number): void {
    this.resize(many);
    this.of_a_show_ = true;
  }

  private resize(many: number): void {
    const { index, flags } = this;
    this.index = new Uint32Array(many).fill(kNothing);
    this.flags = new Uint8Array(many);
    this.index.set(index.subarray(0, many));
    this.flags.set(flags.subarray(0, many));
  }

  take(frame: { all: boolean; runs: NodeRun[] }): void {
    if (frame.all) {
      this.index.fill(kNothing);
      this.flags.fill(0);
    }
    for (const run of frame.runs) {
      const end = run.first + run.many;
      if (end > this.many && !this.of_a_show_ && end <= kMostNodes) this.resize(end);
      if (end > this.many) continue; // of a rig that is not ours
      this.index.fill(run.index, run.first, end);
      this.flags.fill(run.flags, run.first, end);
    }
  }

  /** Switches that some node shows. */
  switches(): Set<number> {
    const found = new Set<number>(this.index);
    found.delete(kNothing);
    return found;
  }

  drawn_state(node: number): number {
    const flags = this.flags[node];
    if ((flags & (kSilent | kQuarantined)) !== 0) return kDrawnSilent;
    return (flags & (kRight | kUnverified)) === 0 ? kDrawnWrong : 0;
  }

  /** How many are in each state. */
  figures(): { right: number; wrong: number; silent: number; quarantined: number; unverified: number } {
    const out = { right: 0, wrong: 0, silent: 0, quarantined: 0, unverified: 0 };
    for (const flags of this.flags) {
      if (flags & kQuarantined) ++out.quarantined;
      else if (flags & kSilent) ++out.silent;
      else if (flags & kUnverified) ++out.unverified;
      else if (flags & kRight) ++out.right;
      else ++out.wrong;
    }
    return out;
  }
}

/** Index of the switch that the plan wants at an instant; -1 before the first. @param times_s ascending */
export function switch_at(times_s: ArrayLike<number>, time_s: number): number {
  let low = 0;
  let high = times_s.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times_s[middle] <= time_s + 1e-6) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
