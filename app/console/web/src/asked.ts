// SPDX-License-Identifier: Apache-2.0
// What wants a word: a change of the show's files, a probe lamp, a node that is being exchanged for a spare.

import { by_id, set_flag, set_text, show_if } from "./dom";
import type { Model } from "./model";
import type { Edit } from "./protocol";
import { say } from "./words";

/** Head, text, and whether it can be taken or given up. Pure. */
export function edit_text(edit: Edit): { head: string; text: string; takes: boolean; drops: boolean } | undefined {
  const n = {
    transitions: edit.transitions === 1 ? say("one_transition") : say("many_transitions", { n: edit.transitions }),
    people: edit.people === 1 ? say("one_person") : say("many_people", { n: edit.people.toLocaleString("en") }),
  };
  switch (edit.state) {
    case "planning":
      return { head: say("edit_planning"), text: "", takes: false, drops: true };
    case "wrong":
      return { head: say("edit_wrong"), text: edit.text, takes: false, drops: true };
    case "waits":
      return { head: say("edit_waits", n), text: edit.text, takes: true, drops: true };
    case "taking":
      return { head: say("edit_taking", n), text: say("edit_when"), takes: false, drops: true };
    default:
      return undefined;
  }
}

export function draw_edit(model: Model): void {
  const { edit } = model.state ?? {};
  const told = edit && edit_text(edit);
  show_if(by_id("edit"), told !== undefined);
  if (!edit || !told) return;
  set_flag(by_id("edit"), "data-state", edit.state);
  set_text(by_id("edit_head"), told.head);
  set_text(by_id("edit_text"), told.text);
  show_if(by_id("edit_text"), told.text !== "");
  show_if(by_id("take"), told.takes && model.role !== "view");
  show_if(by_id("discard"), told.drops && model.role !== "view");
}

/** A lamp that somebody has to look at. */
export function draw_question(model: Model): void {
  const { question } = model.state ?? {};
  show_if(by_id("question"), !!question && model.role !== "view");
  if (question) set_text(by_id("question_text"), question.text);
}

export function draw_swap(model: Model): void {
  const swap = model.state?.swap;
  show_if(by_id("swap"), !!swap);
  if (!swap) return;
  set_flag(by_id("swap"), "data-step", swap.step);
  set_text(by_id("swap_name"), say("swap_of", { node: swap.node }));
  set_text(by_id("swap_text"), swap.text);
  for (const step of ["unplug", "plug-in", "done"]) set_flag(by_id(`swap_${step}`), "aria-current", swap.step === step ? "step" : null);
  show_if(by_id("swap_off"), model.role !== "view");
  set_text(by_id("swap_off"), say(swap.step === "done" ? "close" : "give_up"));
}
