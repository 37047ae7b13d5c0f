// SPDX-License-Identifier: Apache-2.0
// People, groups, cells and nodes by what somebody types. Pure but for `FindPanel`.

import { cell_name } from "./cell_name";
import { by_id, make } from "./dom";
import type { Model } from "./model";
import type { Show } from "./protocol";
import { say } from "./words";

export interface Found {
  kind: "performer" | "cell" | "node";
  index: number;
  text: string;
}

const kMost = 100;

/** "A1" -> cell; undefined: no such cell. */
export function cell_from(text: string, columns: number, rows: number): number | undefined {
  const parts = /^([A-Za-z]{1,3})(\d{1,4})$/.exec(text);
  if (!parts) return undefined;
  let column = 0;
  for (const letter of parts[1].toUpperCase()) column = column * 26 + letter.charCodeAt(0) - 64;
  const row = Number(parts[2]) - 1;
  return column <= columns && row >= 0 && row < rows ? row * columns + column - 1 : undefined;
}

/** "7" or "100-200", numbers of people as they stand in the show, from 1. */
export function range_from(text: string): { from: number; to: number } | undefined {
  const parts = /^(\d{1,7})(?:\s*[-–]\s*(\d{1,7}))?$/.exec(text);
  if (!parts) return undefined;
  const from = Number(parts[1]);
  return { from, to: parts[2] === undefined ? from : Number(parts[2]) };
}

/** What fits, at most `kMost`: exact names first, then a range, a cell, groups, then whatever contains it. */
export function find(show: Show, typed: string): Found[] {
  const text = typed.trim().toLowerCase();
  if (!text) return [];
  const exact: Found[] = [];
  const others: Found[] = [];
  const range = range_from(text);
  show.performers.forEach((one, i) => {
    const group = one.group === null ? "" : show.groups[one.group]?.name ?? "";
    const name = one.name ?? "";
    const found: Found = { kind: "performer", index: i, text: [one.id, name !== one.id ? name : "", group].filter(Boolean).join(" · ") };
    const id = one.id.toLowerCase();
    if (id === text || name.toLowerCase() === text) exact.push(found);
    else if ((range && i + 1 >= range.from && i + 1 <= range.to) || group.toLowerCase() === text) others.push(found);
    else if (others.length < kMost && (id.includes(text) || name.toLowerCase().includes(text))) others.push(found);
  });
  const cell = cell_from(text, show.stage.columns, show.stage.rows);
  if (cell !== undefined) exact.push({ kind: "cell", index: cell, text: cell_name(cell, show.stage.columns) });
  show.rig.forEach((node, i) => {
    const found: Found = { kind: "node", index: i, text: `${node.name} · ${show.buses[node.bus]?.name ?? ""} ${node.address}` };
    if (node.name.toLowerCase() === text) exact.push(found);
    else if (node.name.toLowerCase().includes(text)) others.push(found);
  });
  return [...exact, ...others].slice(0, kMost);
}

/** Everybody whom a range or the name of a group means; none: it is neither. */
export function many(show: Show, typed: string): number[] {
  const text = typed.trim().toLowerCase();
  const range = range_from(text);
  const out: number[] = [];
  show.performers.forEach((one, i) => {
    const numbered = range !== undefined && range.from < range.to && i + 1 >= range.from && i + 1 <= range.to;
    const group = one.group === null ? undefined : show.groups[one.group]?.name.toLowerCase();
    if (numbered || (text !== "" && group === text)) out.push(i);
  });
  return out;
}

export class FindPanel {
  private readonly typed_ = by_id<HTMLInputElement>("search");

  /** @param take_all a range or a group, as a whole */
  constructor(private readonly model_: Model, private readonly take_: (found: Found) => void, private readonly take_all_: (performers: number[]) => void) {
    this.typed_.addEventListener("input", () => this.draw());
    this.typed_.addEventListener("keydown", (event) => {
      const { show } = this.model_;
      if (event.key !== "Enter" || !show) return;
      const all = many(show, this.typed_.value);
      const first = find(show, this.typed_.value)[0];
      if (all.length > 1) this.take_all_(all);
      else if (first) this.take_(first);
    });
  }

  focus(): void {
    this.typed_.focus();
    this.typed_.select();
  }

  private draw(): void {
    const { show } = this.model_;
    if (!show) return;
    const all = find(show, this.typed_.value);
    const rows: HTMLElement[] = all.map((found) => {
      const row = make("li");
      const button = make("button", found.text);
      button.addEventListener("click", () => this.take_(found));
      row.append(button);
      return row;
    });
    const together = many(show, this.typed_.value);
    if (together.length > 1) {
      const row = make("li");
      const button = make("button", say("select_all", { n: together.length.toLocaleString("en") }), "all");
      button.addEventListener("click", () => this.take_all_(together));
      row.append(button);
      rows.unshift(row);
    }
    if (all.length === 0 && this.typed_.value.trim()) rows.push(make("li", say("nobody")));
    by_id("found").replaceChildren(...rows);
  }
}
