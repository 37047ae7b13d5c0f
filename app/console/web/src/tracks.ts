// SPDX-License-Identifier: Apache-2.0
// Where everybody stands at every instant. Pure.

/** Marks of all performers, one after the other: performer p owns marks starts[p] up to starts[p + 1]. */
export interface Tracks {
  starts: Uint32Array; // one more than performers
  marks: Int32Array; // time in ms, cell; times ascend for each performer
}

export interface Point {
  x: number; // m, + is stage left
  y: number; // m, + is upstage
}

/** The mark at or before an instant; the first one before the beginning. O(log marks) */
export function mark_before(tracks: Tracks, performer: number, time_ms: number): number {
  let low = tracks.starts[performer];
  let high = tracks.starts[performer + 1];
  while (high - low > 1) {
    const middle = (low + high) >>> 1;
    if (tracks.marks[2 * middle] <= time_ms) low = middle;
    else high = middle;
  }
  return low;
}

/** Straight and of constant speed between marks. @param centres x, y of every cell, m */
export function position_at(tracks: Tracks, centres: Float32Array, performer: number, time_ms: number): Point {
  const { starts, marks } = tracks;
  const mark = mark_before(tracks, performer, time_ms);
  const begins_ms = marks[2 * mark];
  const a = 2 * marks[2 * mark + 1];
  const from = { x: centres[a], y: centres[a + 1] };
  if (mark + 1 >= starts[performer + 1] || time_ms <= begins_ms) return from;
  const share = (time_ms - begins_ms) / (marks[2 * mark + 2] - begins_ms);
  const b = 2 * marks[2 * mark + 3];
  return { x: from.x + share * (centres[b] - from.x), y: from.y + share * (centres[b + 1] - from.y) };
}

/** The next instant at which somebody who walks now, or walks next, stands elsewhere; undefined at the end. */
export function next_place(tracks: Tracks, performer: number, time_ms: number): { time_ms: number; cell: number } | undefined {
  const mark = mark_before(tracks, performer, time_ms);
  for (let next = mark + 1; next < tracks.starts[performer + 1]; ++next) {
    if (tracks.marks[2 * next] > time_ms && tracks.marks[2 * next + 1] !== tracks.marks[2 * mark + 1]) {
      return { time_ms: tracks.marks[2 * next], cell: tracks.marks[2 * next + 1] };
    }
  }
  return undefined;
}

/** Who is nearest to a place, no farther than `most_m`; -1: nobody. */
export function nearest(tracks: Tracks, centres: Float32Array, time_ms: number, at: Point, most_m: number): number {
  let found = -1;
  let least = most_m * most_m;
  for (let performer = 0; performer + 1 < tracks.starts.length; ++performer) {
    const p = position_at(tracks, centres, performer, time_ms);
    const squared = (p.x - at.x) ** 2 + (p.y - at.y) ** 2;
    if (squared < least) {
      least = squared;
      found = performer;
    }
  }
  return found;
}
