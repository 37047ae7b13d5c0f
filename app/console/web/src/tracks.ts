// SPDX-License-Identifier: Apache-2.0
// Where everybody stands at every instant. Pure.

/** Marks of all performers, one after the other: performer p owns marks starts[p] up to starts[p + 1]. */
export interface Tracks {
  starts: Uint32Array; // one more than performers
  times_ms: Int32Array; // strictly ascending for each performer
  cells: Uint32Array;
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
    if (tracks.times_ms[middle] <= time_ms) low = middle;
    else high = middle;
  }
  return low;
}

/** Straight and of constant speed between marks. @param centres x, y of every cell, m */
export function position_at(tracks: Tracks, centres: Float32Array, performer: number, time_ms: number): Point {
  const mark = mark_before(tracks, performer, time_ms);
  const a = tracks.cells[mark];
  const from = { x: centres[2 * a], y: centres[2 * a + 1] };
  if (mark + 1 >= tracks.starts[performer + 1] || time_ms <= tracks.times_ms[mark]) return from;
  const share = (time_ms - tracks.times_ms[mark]) / (tracks.times_ms[mark + 1] - tracks.times_ms[mark]);
  const b = tracks.cells[mark + 1];
  return { x: from.x + share * (centres[2 * b] - from.x), y: from.y + share * (centres[2 * b + 1] - from.y) };
}

/** The next instant at which somebody who walks now, or walks next, stands elsewhere; undefined at the end. */
export function next_place(tracks: Tracks, performer: number, time_ms: number): { time_ms: number; cell: number } | undefined {
  const mark = mark_before(tracks, performer, time_ms);
  for (let next = mark + 1; next < tracks.starts[performer + 1]; ++next) {
    if (tracks.times_ms[next] > time_ms && tracks.cells[next] !== tracks.cells[mark]) {
      return { time_ms: tracks.times_ms[next], cell: tracks.cells[next] };
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
