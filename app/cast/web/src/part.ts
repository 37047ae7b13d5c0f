// SPDX-License-Identifier: Apache-2.0
// What somebody does now, and what comes next. Pure.

/** As a sheet has it (docs/paper.md): arrives at from_s, leaves at until_s. */
export interface Place {
  from_s: number;
  until_s: number;
  cell: number;
  count: string;
  measure: string;
  place: string;
  stay: string;
  way: string; // to the next place
  beside: string;
}

export interface Now {
  walks: boolean;
  here: Place; // where she stands, or where she has come from
  next?: Place; // where she goes now, or then
  change_s?: number; // when she sets out, or arrives
  then?: Place; // behind `next`
}

export function now_of(places: Place[], at_s: number): Now | undefined {
  if (places.length === 0) return undefined;
  let k = 0;
  while (k + 1 < places.length && places[k + 1].from_s <= at_s) ++k;
  const here = places[k];
  const next = places[k + 1];
  if (!next) return { walks: false, here };
  const walks = at_s > here.until_s || (at_s === here.until_s && here.until_s > here.from_s);
  return { walks, here, next, change_s: walks ? next.from_s : here.until_s, then: places[k + 2] };
}

/** Her own places with a way in before them: from where the way joins on they are the plan's. */
export function with_way(places: Place[], way: Place[]): Place[] {
  const joins = way[way.length - 1];
  const later = places.filter((one) => one.until_s > joins.from_s);
  if (later.length > 0 && later[0].cell === joins.cell && later[0].from_s <= joins.from_s) {
    return [...way.slice(0, -1), { ...joins, until_s: later[0].until_s, way: later[0].way, stay: later[0].stay }, ...later.slice(1)];
  }
  return [...way, ...later.filter((one) => one.from_s > joins.from_s)];
}
