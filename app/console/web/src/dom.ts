// SPDX-License-Identifier: Apache-2.0
// The few things that the page does to its elements. What comes from a show goes in as text alone.

export function by_id<E extends HTMLElement = HTMLElement>(id: string): E {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as E;
}

/** Touches the page only when something has changed. */
export function set_text(part: Element, text: string): void {
  if (part.textContent !== text) part.textContent = text;
}

export function set_flag(part: Element, name: string, value: string | null): void {
  if (value === null) {
    if (part.hasAttribute(name)) part.removeAttribute(name);
  } else if (part.getAttribute(name) !== value) {
    part.setAttribute(name, value);
  }
}

export function show_if(part: HTMLElement, shown: boolean): void {
  if (part.hidden === shown) part.hidden = !shown;
}

/** A new element with text and class. */
export function make<K extends keyof HTMLElementTagNameMap>(tag: K, text = "", kind = ""): HTMLElementTagNameMap[K] {
  const part = document.createElement(tag);
  if (text) part.textContent = text;
  if (kind) part.className = kind;
  return part;
}

/** Term and description pairs of a list. */
export function set_facts(list: HTMLElement, facts: [string, string][]): void {
  const now = facts.map(([name, value]) => `${name}\0${value}`).join("\n");
  if (list.dataset.facts === now) return;
  list.dataset.facts = now;
  list.replaceChildren(...facts.flatMap(([name, value]) => [make("dt", name), make("dd", value)]));
}
