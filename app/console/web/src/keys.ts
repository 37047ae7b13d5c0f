// SPDX-License-Identifier: Apache-2.0
// Keys. Space is GO and nothing else but in a text field; Esc is HOLD when nothing is open.

/** What the keys do. */
export interface Desk {
  go(): void;
  hold(): void;
  hold_end(): void;
  say(order: string): void;
  ask(prefix: string): void;
  loop(): void;
  mute(): void;
  solo(): void;
  tempo(by_percent: number): void;
  move(by: number): void;
  jump(): boolean;
  placed(): void;
  ok(): void;
  find(): void;
  help(): void;
  /** Closes what is open. @return false: nothing was */
  close(): boolean;
  view(what: "front" | "people" | "lamps" | "ghosts" | "ways" | "all"): void;
  zoom(factor: number): void;
}

/** One press is one GO: a key that is held repeats and is not meant. */
export class Presses {
  private readonly down_ = new Set<string>();

  press(code: string, repeats: boolean): boolean {
    const fresh = !repeats && !this.down_.has(code);
    this.down_.add(code);
    return fresh;
  }

  release(code: string): void {
    this.down_.delete(code);
  }

  /** The window lost its keys: nobody knows what is held. */
  forget(): void {
    this.down_.clear();
  }
}

// The letters are those of the terminal: docs/live.md has the table.
const kOrders: Record<string, string> = { b: "back", t: "top", s: "step", c: "cancel", ".": "tap" };

export function listen_to_keys(desk: Desk): void {
  const presses = new Presses();
  addEventListener("blur", () => presses.forget());
  // A button that a hand has pressed does not keep the keys: Enter would press it again.
  addEventListener("click", (event) => {
    if (event.detail > 0 && event.target instanceof Element) event.target.closest("button")?.blur();
  });
  addEventListener("keyup", (event) => {
    presses.release(event.code);
    // Nor does it press the button that has the focus.
    if (event.key === " " && !(event.target instanceof HTMLInputElement)) event.preventDefault();
  });
  addEventListener("keydown", (event) => {
    const target = event.target instanceof HTMLElement ? event.target : document.body;
    const types = target instanceof HTMLInputElement && target.type !== "range";
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Escape") {
      event.preventDefault();
      if (!desk.close() && presses.press(event.code, event.repeat)) desk.hold();
      return;
    }
    if (types) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const fresh = presses.press(event.code, event.repeat);
    if (key === "Enter" && !(target instanceof HTMLButtonElement) && desk.jump()) return event.preventDefault();
    const scrubs = target instanceof HTMLInputElement && /^(Arrow|Home|End|Page)/.test(key);
    if (scrubs || key === "Tab" || key === "Enter") return;
    if (act(desk, key, fresh)) event.preventDefault();
  }, { capture: true });
}

/** @return whether the key means something */
function act(desk: Desk, key: string, fresh: boolean): boolean {
  const once = (what: () => void) => {
    if (fresh) what();
    return true;
  };
  if (kOrders[key]) return once(() => desk.say(kOrders[key]));
  switch (key) {
    case " ":
      return once(() => desk.go());
    case "h":
      return once(() => desk.hold());
    case "e":
      return once(() => desk.hold_end());
    case "l":
      return once(() => desk.loop());
    case "m":
      return once(() => desk.mute());
    case "o":
      return once(() => desk.solo());
    case "j":
      return once(() => desk.ask("jump "));
    case "n":
      return once(() => desk.ask("note "));
    case ":":
      return once(() => desk.ask(""));
    case "p":
      return once(() => desk.placed());
    case "a":
      return once(() => desk.ok());
    case "/":
      return once(() => desk.find());
    case "?":
      return once(() => desk.help());
    case "v":
      return once(() => desk.view("front"));
    case "+":
    case "=":
      return once(() => desk.tempo(5));
    case "-":
      return once(() => desk.tempo(-5));
    case "1":
    case "2":
    case "3":
    case "4":
      return once(() => desk.view((["people", "lamps", "ghosts", "ways"] as const)[Number(key) - 1]));
    case "0":
      return once(() => desk.view("all"));
    case "ArrowDown":
    case "ArrowUp":
      desk.move(key === "ArrowDown" ? 1 : -1);
      return true;
    case "PageUp":
    case "PageDown":
      desk.zoom(key === "PageUp" ? 1.25 : 0.8);
      return true;
    default:
      return false;
  }
}
