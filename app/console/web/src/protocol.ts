// SPDX-License-Identifier: Apache-2.0
// What the program sends: docs/console.md. Decoding is pure; everything that comes is checked before it is used.

import type { Tracks } from "./tracks";

export interface Cue {
  number: string;
  name: string;
  from_s: number;
  to_s: number;
  gap_after_s: number | null;
  pre_wait_s?: number;
  post_wait_s?: number;
  continue?: string;
  notes?: string;
  most_percent?: number;
  because?: string;
}

export interface Show {
  epoch: number;
  title: string;
  version: string;
  plan: string;
  markers: number;
  nodes: number;
  switches: number;
  stage: {
    grid: "square" | "hexagonal" | "triangular";
    columns: number;
    rows: number;
    pitch_m: number;
    clearance_m: number;
    blocked: number[];
    wings: number[];
  };
  groups: { name: string; colour: string }[];
  performers: { id: string; name?: string; group: number | null; absent?: boolean }[];
  sections: { name: string; start_s: number; end_s: number; start_count: number }[];
  formations: { id: string; section: number; count: number; time_s: number; key: boolean }[];
  cues: Cue[];
  tempo: { count: number; time_s: number; bpm: number }[];
  switch_at: { time_s: number; cause: string; cue: number | null }[];
  buses: { name: string; kind: string; url: string }[];
  rig: { name: string; bus: number; address: number; channels: (number | null)[] }[];
  looks: { colour: string; effect: string; brightness: number }[];
}

export interface State {
  phase: string;
  position_s: number;
  rate?: number;
  section: string;
  measure: string;
  count: number;
  cue: string | null;
  standby: string | null;
  goes_in_s: number | null;
  ends_in_s: number | null;
  tempo_percent: number;
  most_percent: number;
  holds_at_end: boolean;
  /** Groups; empty: nobody. */
  muted: string;
  loop: { from_s: number; to_s: number } | null;
  reset: { state: string; from_s?: number; to_s?: number; at_s?: number };
  against?: unknown; // who bars people from walking
  gates?: unknown;
  standby_notes?: string;
  /** What a HOLD would do now; null: it is being judged. */
  freeze?: { pairs: number; until_count: number | null; resume_pairs: number } | null;
  edit?: Edit;
  /** A node that is exchanged for a spare, step by step; null: none is. */
  swap?: { node: string; step: string; text: string } | null;
  most_because?: string;
  /** Before a show has its buses: a lamp that somebody has to look at. */
  question?: { text: string; cell: string } | null;
  switch: number;
  ready: boolean;
  buses: { name: string; nodes: number; unconfirmed: number; trouble?: string }[];
  [more: string]: unknown; // what newer programs tell
}

/** What has changed and does not play yet, and who does not come. */
export interface Edit {
  state: string; // none, planning, wrong, waits, taking
  text: string;
  transitions: number;
  people: number;
  untold: number;
  absent: { id: string; cover: string | null }[];
}

export interface BusHealth {
  name: string;
  nodes: number;
  unconfirmed: number;
  quarantined: number;
  deliveries: number;
  retries: number;
  misses: number;
  boots: number;
  late_latches: number;
  worst_lateness_ms: number;
}

export interface Alarm {
  n: number;
  text: string;
  unix_ms: number;
  acknowledged_by: string | null;
}

export interface RunEvent {
  n: number;
  unix_ms: number;
  answer?: { order: string; who: string; refused: boolean; text: string; id?: number };
  moment?: string;
  reset?: string;
  alarm?: string;
  note?: string;
}

/** Centres of all cells, m: x, y of each. */
export function centres_of(stage: Show["stage"]): Float32Array {
  const { columns, rows, pitch_m: p, grid } = stage;
  const centres = new Float32Array(2 * columns * rows);
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const middle = column - (columns - 1) / 2;
      let x = middle * p;
      let y = (row + 0.5) * p;
      if (grid === "hexagonal") {
        x = (middle + (row % 2 === 1 ? 0.5 : 0)) * p;
        y = (1 / Math.sqrt(3) + (row * Math.sqrt(3)) / 2) * p;
      } else if (grid === "triangular") {
        x = (middle * p * Math.sqrt(3)) / 2;
        y = (1.5 * row + ((column + row) % 2 === 0 ? 0.5 : 1)) * p;
      }
      const at = 2 * (row * columns + column);
      centres[at] = x;
      centres[at + 1] = y;
    }
  }
  return centres;
}

class Words {
  private readonly view_: DataView;
  constructor(private readonly bytes_: ArrayBuffer, private at_ = 0) {
    this.view_ = new DataView(bytes_);
  }
  next(): number {
    if (this.at_ + 4 > this.bytes_.byteLength) throw new Error("an answer is cut off");
    this.at_ += 4;
    return this.view_.getUint32(this.at_ - 4, true);
  }
  expect(magic: string): void {
    const found = String.fromCharCode(...new Uint8Array(this.bytes_, 0, Math.min(4, this.bytes_.byteLength)));
    if (found !== magic) throw new Error(`an answer begins with ${JSON.stringify(found)}, not ${magic}`);
    this.at_ = 4;
    const version = this.next();
    if (version !== 1) throw new Error(`${magic} has version ${version}; reload this page`);
  }
  at(): number {
    return this.at_;
  }
}

/** plan.bin and way.bin. @param cells how many the floor has */
export function decode_plan(bytes: ArrayBuffer, cells: number): { epoch: number; tracks: Tracks } {
  const words = new Words(bytes);
  words.expect("FLPM");
  const epoch = words.next();
  const people = words.next();
  const many = words.next();
  const begin = words.at();
  if (bytes.byteLength !== begin + 4 * (people + 1) + 8 * many) throw new Error("plan.bin is not as long as it says");
  const starts = new Uint32Array(bytes, begin, people + 1);
  const times_s = new Float32Array(bytes, begin + 4 * (people + 1), many);
  const where = new Uint32Array(bytes, begin + 4 * (people + 1) + 4 * many, many);
  for (let p = 0; p < people; ++p) if (starts[p] >= starts[p + 1]) throw new Error(`performer ${p + 1} has no marks`);
  if (starts[0] !== 0 || starts[people] !== many) throw new Error("plan.bin: marks that are nobody's");
  const marks = new Int32Array(2 * many);
  for (let i = 0; i < many; ++i) {
    if (where[i] >= cells) throw new Error(`plan.bin: cell ${where[i]} of ${cells}`);
    marks[2 * i] = Math.round(times_s[i] * 1000);
    marks[2 * i + 1] = where[i];
  }
  return { epoch, tracks: { starts, marks } };
}

export const kChannels = 32; // of a node

/** looks/K.bin: the look of each channel, node by node. */
export function decode_looks(bytes: ArrayBuffer): { epoch: number; index: number; looks: Uint8Array } {
  const words = new Words(bytes);
  words.expect("FLLK");
  const epoch = words.next();
  const index = words.next();
  const nodes = words.next();
  if (bytes.byteLength !== words.at() + kChannels * nodes) throw new Error("looks are not as long as they say");
  return { epoch, index, looks: new Uint8Array(bytes, words.at()) };
}

export const kNothing = 0xffffffff; // no switch was confirmed yet
export const kRight = 1;
export const kSilent = 2;
export const kQuarantined = 4;
export const kUnverified = 8;

export interface NodeRun {
  first: number;
  many: number;
  index: number; // switch
  flags: number;
}

/** @return undefined for a frame of another kind */
export function decode_nodes(bytes: ArrayBuffer): { all: boolean; runs: NodeRun[] } | undefined {
  const head = new Uint8Array(bytes, 0, Math.min(4, bytes.byteLength));
  if (head[0] !== 1) return undefined;
  const words = new Words(bytes, 4);
  const many = words.next();
  if (bytes.byteLength !== 8 + 16 * many) throw new Error("a frame of nodes is not as long as it says");
  const runs: NodeRun[] = [];
  for (let i = 0; i < many; ++i) {
    runs.push({ first: words.next(), many: words.next(), index: words.next(), flags: words.next() });
  }
  return { all: (head[1] & 1) !== 0, runs };
}
