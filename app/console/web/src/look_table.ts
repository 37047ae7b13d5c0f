// SPDX-License-Identifier: Apache-2.0
// Colours as small textures. Pure.

import type { Show } from "./protocol";

/** 0..255 each; black where it is none. */
export function rgb(colour: string): [number, number, number] {
  const value = /^#[0-9a-f]{6}$/i.test(colour) ? parseInt(colour.slice(1), 16) : 0;
  return [value >> 16, (value >> 8) & 255, value & 255];
}

const kEffects = ["steady", "blink", "pulse", "double-blink", "count-down"];

/** 256 texels: colour with brightness, effect in alpha. */
export function look_table(show: Show): Uint8Array {
  const table = new Uint8Array(4 * 256);
  show.looks.slice(0, 255).forEach((look, i) => {
    // Shown brighter than it is: a dim lamp must be seen on a screen.
    const share = look.brightness === 0 ? 0 : 0.4 + (0.6 * look.brightness) / 255;
    table.set(rgb(look.colour).map((value) => Math.round(value * share)), 4 * i);
    table[4 * i + 3] = Math.max(0, kEffects.indexOf(look.effect));
  });
  table.set([100, 75, 0, 0], 4 * 255);
  return table;
}

export const kNoGroup = 255;

/** 256 texels: colours of groups, and of who has none. */
export function group_table(show: Show): Uint8Array {
  const table = new Uint8Array(4 * 256).fill(255);
  show.groups.slice(0, kNoGroup).forEach((group, i) => table.set(rgb(group.colour), 4 * i));
  table.set([220, 220, 220, 255], 4 * kNoGroup);
  return table;
}
