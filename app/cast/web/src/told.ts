// SPDX-License-Identifier: Apache-2.0
// What the program tells phones: docs/cast.md.

import { type Show } from "../../../console/web/src/protocol";
import { type Tempo } from "./counts";
import { type Place } from "./part";

export type CastShow = Pick<Show, "title" | "plan" | "stage" | "performers" | "cues"> & Tempo;

export interface State {
  heard: boolean;
  same_plan: boolean;
  epoch: number;
  phase?: string;
  at_ms: number;
  position_s: number;
  rate: number;
  goes_at_ms: number | null;
  stops_s: number | null;
  holds_at_end: boolean;
  cue: string;
  standby: string;
  tempo_percent: number;
  way: { n: number; at_s: number | null; rate: number } | null;
}

export interface Where {
  kind: string;
  who?: number;
  at_once?: boolean;
  until_s?: number;
  ask_s?: number;
  places?: Place[];
}

/** "D12" -> its cell; -1: there is none. Pure. */
export function cell_from(text: string, stage: Show["stage"]): number {
  const parts = /^([A-Z]{1,3})([0-9]{1,4})$/.exec(text.trim().toUpperCase());
  if (!parts) return -1;
  let column = 0;
  for (const letter of parts[1]) column = 26 * column + letter.charCodeAt(0) - 64;
  const row = Number(parts[2]);
  const there = column >= 1 && column <= stage.columns && row >= 1 && row <= stage.rows;
  return there ? (row - 1) * stage.columns + column - 1 : -1;
}
