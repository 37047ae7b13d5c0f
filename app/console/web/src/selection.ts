// SPDX-License-Identifier: Apache-2.0
// Who is looked at: picked on the stage, or found by name, number or group.

import type { Found } from "./find";
import type { Model } from "./model";
import { colour_of, flags_of } from "./show_data";
import type { StageView } from "./stage_view";
import { position_at } from "./tracks";

const kNear = 4; // times nearer, to see one cell

export class Selection {
  constructor(private readonly model_: Model, private readonly stage_: () => StageView | undefined) {}

  /** @param performer -1: nobody */
  take(performer: number): void {
    this.take_all(performer >= 0 ? [performer] : []);
  }

  /** One is looked at, with her whole way; of many only where they are. */
  take_all(performers: readonly number[]): void {
    const { show, selected, marked } = this.model_;
    const before = selected >= 0 ? [selected] : marked;
    this.model_.selected = performers.length === 1 ? performers[0] : -1;
    this.model_.marked = performers.length > 1 ? performers : [];
    const scene = this.stage_()?.scene;
    if (!show || !scene) return;
    for (const one of before) scene.mark_performer(one, colour_of(show, one), flags_of(show, one, false));
    for (const one of performers) scene.mark_performer(one, colour_of(show, one), flags_of(show, one, true));
    this.stage_()?.redraw();
  }

  find(found: Found): void {
    const { show, tracks, centres } = this.model_;
    if (!show || !tracks) return;
    if (found.kind === "performer") {
      this.take(found.index);
      this.stage_()?.go_to(position_at(tracks, centres, found.index, this.model_.shown_s(performance.now()) * 1000));
      return;
    }
    const cell = found.kind === "cell" ? found.index : show.rig[found.index].channels.find((what) => what !== null && what >= 0) ?? -1;
    if (cell < 0) return;
    this.stage_()?.go_to({ x: centres[2 * cell], y: centres[2 * cell + 1] });
    this.stage_()?.zoom(kNear);
  }
}
