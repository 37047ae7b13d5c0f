// SPDX-License-Identifier: Apache-2.0
// What a newer program tells and this page has no place for. Pure.

/** A fact of a state that this page has no place for, in words. Pure. */
export function fact_text(value: unknown): string {
  if (value === null || value === undefined) return "–";
  if (Array.isArray(value)) return value.map(fact_text).join(", ");
  if (typeof value === "object") return Object.entries(value).map(([name, one]) => `${name.replace(/_/g, " ")} ${fact_text(one)}`).join(", ");
  return String(value);
}

/** Nothing to tell. */
export function is_empty(value: unknown): boolean {
  return value === null || value === undefined || value === "" || (Array.isArray(value) && value.length === 0);
}
