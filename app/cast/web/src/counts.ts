// SPDX-License-Identifier: Apache-2.0
// Counts and measures of show time, as core/tempo_map.hpp has them. Pure.

export interface Tempo {
  tempo: { count: number; time_s: number; bpm: number }[];
  meter: { count: number; beats: number }[];
}

function last_before<T>(list: T[], good: (one: T) => boolean): T {
  let found = list[0];
  for (const one of list) if (good(one)) found = one;
  return found;
}

export function count_at(music: Tempo, time_s: number): number {
  const at = last_before(music.tempo, (one) => one.time_s <= time_s);
  return at.count + ((time_s - at.time_s) * at.bpm) / 60;
}

/** "17:3" of a whole count; before measure 1 the measures go on downwards. */
export function measure_beat(music: Tempo, count: number): string {
  let measure = 1;
  for (let i = 0; i < music.meter.length; ++i) {
    const { count: from, beats } = music.meter[i];
    const next = music.meter[i + 1];
    if (!next || count < next.count) {
      const measures = Math.floor((count - from) / beats);
      return `${measure + measures}:${Math.floor(count - from - measures * beats) + 1}`;
    }
    measure += Math.round((next.count - from) / beats);
  }
  return "";
}

/** Whole counts until an instant: 1 is the last one, 0 when it has come. */
export function counts_left(music: Tempo, now_s: number, then_s: number): number {
  return Math.max(0, Math.ceil(count_at(music, then_s) - count_at(music, now_s) - 1e-3));
}
