// SPDX-License-Identifier: Apache-2.0
// Names of cells as the program gives them: column letters and row, A1 downstage on stage right. Pure.

/** 0 -> "A", 25 -> "Z", 26 -> "AA". */
export function column_letters(column: number): string {
  let letters = "";
  for (let rest = column; rest >= 0; rest = Math.floor(rest / 26) - 1) {
    letters = String.fromCharCode(65 + (rest % 26)) + letters;
  }
  return letters;
}

/** @param cell row by row, from downstage, from stage right */
export function cell_name(cell: number, columns: number): string {
  return column_letters(cell % columns) + String(Math.floor(cell / columns) + 1);
}
