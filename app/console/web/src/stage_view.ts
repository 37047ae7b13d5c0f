// SPDX-License-Identifier: Apache-2.0
// The stage as it is seen and touched: camera, pointers, letters along the edges, who was picked.

import { type Box, Camera } from "./camera";
import { EdgeLetters } from "./edge_letters";
import { by_id, set_text, show_if } from "./dom";
import type { Model } from "./model";
import { type Palette, Scene } from "./scene";
import { nearest, type Point } from "./tracks";
import { say } from "./words";

/** What frames cost since somebody began to measure. */
export interface Cost {
  frames: number;
  draws: number;
  bytes: number;
  worst_draws: number;
  worst_bytes: number; // of a frame alone
  confirmed_bytes: number; // sent between frames: looks of the next switch, what nodes have confirmed
}

function no_cost(): Cost {
  return { frames: 0, draws: 0, bytes: 0, worst_draws: 0, worst_bytes: 0, confirmed_bytes: 0 };
}

export interface Choices {
  people: boolean;
  lamps: boolean;
  ghosts: boolean;
  ways: boolean;
}

const kWaysAhead_ms = 8000;
const kPick_px = 18;

/** Around all cells. */
export function box_of(centres: Float32Array, pitch_m: number): Box {
  const box = { low: { x: Infinity, y: Infinity }, high: { x: -Infinity, y: -Infinity } };
  for (let i = 0; i < centres.length; i += 2) {
    box.low.x = Math.min(box.low.x, centres[i]);
    box.low.y = Math.min(box.low.y, centres[i + 1]);
    box.high.x = Math.max(box.high.x, centres[i]);
    box.high.y = Math.max(box.high.y, centres[i + 1]);
  }
  const half = 0.5 * pitch_m;
  return { low: { x: box.low.x - half, y: box.low.y - half }, high: { x: box.high.x + half, y: box.high.y + half } };
}

function palette(): Palette {
  const style = getComputedStyle(document.documentElement);
  const of = (name: string) => {
    const value = parseInt(style.getPropertyValue(name).trim().replace(/^#(.)(.)(.)$/, "#$1$1$2$2$3$3").slice(1), 16);
    return [value >> 16, (value >> 8) & 255, value & 255].map((part) => part / 255);
  };
  const line = of("--line");
  const ground = of("--ground");
  return {
    ground,
    line: line.map((part, i) => 0.55 * part + 0.45 * ground[i]),
    wing: line.map((part, i) => 0.35 * part + 0.65 * ground[i]),
    blocked: of("--faint"),
    edge: ground,
    selected: of("--ink"),
    wrong: of("--wrong"),
    ink: of("--ink"),
  };
}

export class StageView {
  readonly camera = new Camera();
  readonly scene: Scene;
  readonly choices: Choices = { people: true, lamps: true, ghosts: true, ways: true };
  private readonly floor_ = by_id<HTMLCanvasElement>("floor");
  private readonly labels_ = by_id<HTMLCanvasElement>("labels");
  private readonly pointers_ = new Map<number, { x: number; y: number }>();
  private moved_ = false;
  private readonly letters_ = new EdgeLetters(this.labels_);
  private drawn_ = "";
  /** Frames and what they cost, for whoever measures. */
  cost: Cost = no_cost();

  constructor(private readonly model_: Model, private readonly picked_: (performer: number) => void) {
    this.scene = new Scene(this.floor_, palette());
    new ResizeObserver(() => this.resize()).observe(this.floor_);
    this.floor_.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.camera.zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
    }, { passive: false });
    this.floor_.addEventListener("pointerdown", (event) => this.down(event));
    this.floor_.addEventListener("pointermove", (event) => this.move(event));
    for (const kind of ["pointerup", "pointercancel"] as const) this.floor_.addEventListener(kind, (event) => this.up(event));
    by_id("closer").addEventListener("click", () => this.zoom(1.5));
    by_id("farther").addEventListener("click", () => this.zoom(1 / 1.5));
    by_id("all").addEventListener("click", () => this.whole());
    by_id("front").addEventListener("click", () => this.turn());
    for (const name of ["people", "lamps", "ghosts", "ways"] as const) by_id(name).addEventListener("click", () => this.choose(name));
  }

  take_show(): void {
    const { show, centres } = this.model_;
    if (show) this.camera.fit(box_of(centres, show.stage.pitch_m));
    this.redraw();
  }

  redraw(): void {
    this.drawn_ = "";
    this.letters_.redraw();
  }

  take_theme(): void {
    this.scene.palette = palette();
    this.redraw();
  }

  turn(): void {
    this.camera.front = !this.camera.front;
    this.camera.reset();
    by_id("front").setAttribute("aria-pressed", String(this.camera.front));
  }

  whole(): void {
    this.camera.reset();
  }

  choose(name: keyof Choices): void {
    this.choices[name] = !this.choices[name];
    by_id(name).setAttribute("aria-pressed", String(this.choices[name]));
  }

  zoom(factor: number): void {
    this.camera.zoom(factor, this.camera.size.width / 2, this.camera.size.height / 2);
  }

  /** Looks at a place from near. */
  go_to(at: Point): void {
    const { width, height } = this.camera.size;
    const now = this.camera.project(at);
    this.camera.pan(now.x, now.y, width / 2, height / 2);
  }

  private resize(): void {
    this.camera.size = { width: Math.max(1, this.floor_.clientWidth), height: Math.max(1, this.floor_.clientHeight) };
    this.fit(this.labels_);
    this.redraw();
  }

  /** Empties it: only just before it is drawn. Until then what it has is stretched. */
  private fit(canvas: HTMLCanvasElement): void {
    const width = Math.round(this.camera.size.width * devicePixelRatio);
    const height = Math.round(this.camera.size.height * devicePixelRatio);
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
  }

  private down(event: PointerEvent): void {
    this.floor_.setPointerCapture(event.pointerId);
    this.pointers_.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    this.moved_ = this.pointers_.size > 1;
  }

  private move(event: PointerEvent): void {
    const before = this.pointers_.get(event.pointerId);
    if (!before) return;
    const now = { x: event.offsetX, y: event.offsetY };
    const distance = Math.hypot(now.x - before.x, now.y - before.y);
    if (!this.moved_ && distance < 4) return;
    this.moved_ = true;
    const other = [...this.pointers_.entries()].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      // Two fingers: what is between them stays between them.
      const apart = (a: Point, b: Point) => Math.hypot(a.x - b.x, a.y - b.y);
      const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
      this.camera.pan((before.x + other.x) / 2, (before.y + other.y) / 2, middle.x, middle.y);
      this.camera.zoom(apart(now, other) / Math.max(1, apart(before, other)), middle.x, middle.y);
    } else {
      this.camera.pan(before.x, before.y, now.x, now.y);
    }
    this.pointers_.set(event.pointerId, now);
  }

  private up(event: PointerEvent): void {
    const known = this.pointers_.delete(event.pointerId);
    if (known && !this.moved_ && event.type === "pointerup") this.pick(event.offsetX, event.offsetY);
  }

  private pick(x: number, y: number): void {
    const { tracks, centres, show } = this.model_;
    if (!tracks || !show) return;
    const at = this.camera.unproject(x, y);
    const scale = this.camera.project(at).scale;
    const reach_m = Math.max(0.6 * show.stage.pitch_m, kPick_px / scale);
    this.picked_(nearest(tracks, centres, this.shown_ms(performance.now()), at, reach_m));
  }

  private shown_ms(now_ms: number): number {
    return Math.round(this.model_.shown_s(now_ms) * 1000);
  }

  /** @param planned layer of the looks of the instant that is looked at; -1: now  @param blinks some lamp does */
  draw(now_ms: number, planned: number, blinks: boolean): void {
    const { model_: model, camera } = this;
    const view = camera.view();
    const shown_s = model.shown_s(now_ms);
    const resets = model.scrub_s === undefined && model.way !== undefined && (model.state?.phase === "resets" || model.state?.phase === "reset-held");
    const time_ms = resets ? Math.round(model.way_clock.at(now_ms) * 1000) : this.shown_ms(now_ms);
    const next_s = model.next_formation_s(resets ? Number(model.state?.reset.to_s ?? shown_s) : shown_s);
    // What blinks needs frames; what stands still does not.
    const blink = this.choices.lamps && blinks ? Math.floor(now_ms / 100) : 0;
    const drawn = [time_ms, next_s, blink, planned, model.selected, resets, view.matrix.join(), Object.values(this.choices).join()].join("|");
    if (drawn !== this.drawn_ && !this.scene.busy(now_ms)) {
      this.cost.confirmed_bytes += this.scene.meter.take().bytes;
      this.fit(this.floor_);
      const whole = this.scene.draw({
        view,
        size_px: { width: this.floor_.width, height: this.floor_.height },
        ratio: devicePixelRatio,
        time_ms,
        ghosts_ms: this.choices.ghosts && next_s !== undefined ? Math.round(next_s * 1000) : undefined,
        ways_ms: this.choices.ways ? kWaysAhead_ms : undefined,
        people: this.choices.people,
        lamps: this.choices.lamps,
        planned,
        selected: model.selected,
        seconds: (now_ms / 1000) % 3600,
        uses_way: resets,
      }, now_ms);
      this.drawn_ = whole ? drawn : "";
      this.count_cost();
    }
    this.letters_.draw(this.model_, this.camera);
    set_text(by_id("legend"), say(planned >= 0 ? "legend_planned" : "legend"));
    show_if(by_id("legend"), model.show !== undefined);
  }

  measure(): void {
    this.scene.meter.take();
    this.cost = no_cost();
  }

  private count_cost(): void {
    const { draws, bytes } = this.scene.meter.take();
    this.cost.frames += 1;
    this.cost.draws += draws;
    this.cost.bytes += bytes;
    this.cost.worst_draws = Math.max(this.cost.worst_draws, draws);
    this.cost.worst_bytes = Math.max(this.cost.worst_bytes, bytes);
  }
}
