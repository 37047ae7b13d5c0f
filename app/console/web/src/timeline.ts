// SPDX-License-Identifier: Apache-2.0
// The show's time: sections and cues along a line, where the show is, and a handle to look at another instant.

import { by_id, set_flag, set_text, show_if } from "./dom";
import type { Model } from "./model";
import { clock_text, count_text, timecode_text } from "./time_text";
import { say } from "./words";

const kFps = 25; // of the timecode where the program tells none
const kFollow_s = 0.02;

/** Beginning and end of what the cues play, s. */
export function span_of(cues: { from_s: number; to_s: number }[]): { from_s: number; to_s: number } {
  if (cues.length === 0) return { from_s: 0, to_s: 1 };
  const from_s = Math.min(...cues.map((cue) => cue.from_s));
  return { from_s, to_s: Math.max(from_s + 1e-3, ...cues.map((cue) => cue.to_s)) };
}

/** The count at an instant, by the changes of tempo. Pure. */
export function count_at(tempo: { count: number; time_s: number; bpm: number }[], time_s: number): number {
  let last = tempo[0];
  if (!last) return 1;
  for (const one of tempo) if (one.time_s <= time_s) last = one;
  return last.count + ((time_s - last.time_s) * last.bpm) / 60;
}

export class Timeline {
  private readonly canvas_ = by_id<HTMLCanvasElement>("track");
  private readonly handle_ = by_id<HTMLInputElement>("scrub");
  private drawn_ = "";

  constructor(private readonly model_: Model, private readonly scrubbed_: () => void) {
    this.handle_.addEventListener("input", () => {
      this.model_.scrub_s = Number(this.handle_.value);
      this.scrubbed_();
    });
    by_id("now").addEventListener("click", () => this.now());
    new ResizeObserver(() => (this.drawn_ = "")).observe(this.canvas_);
  }

  build(): void {
    const span = span_of(this.model_.show?.cues ?? []);
    this.handle_.min = String(span.from_s);
    this.handle_.max = String(span.to_s);
    this.handle_.step = String(Math.max(0.01, (span.to_s - span.from_s) / 2000));
    this.drawn_ = "";
  }

  now(): void {
    this.model_.scrub_s = undefined;
    this.scrubbed_();
  }

  draw(now_ms: number): void {
    const { show, state, scrub_s } = this.model_;
    if (!show || !state) return;
    const shown_s = this.model_.shown_s(now_ms);
    if (scrub_s === undefined && Math.abs(Number(this.handle_.value) - shown_s) > kFollow_s) this.handle_.value = String(shown_s);
    // What stands below is now, whatever is looked at.
    const now_s = this.model_.clock.at(now_ms);
    const count = count_at(show.tempo, shown_s);
    set_text(by_id("beat"), state.measure);
    set_text(by_id("count"), count_text(Math.floor(count_at(show.tempo, now_s) + 1e-6)));
    this.draw_time(now_ms);
    set_text(by_id("tempo"), `${state.tempo_percent} %`);
    set_text(by_id("most"), say("at_most", { most: state.most_percent }));
    set_flag(by_id("most"), "title", state.most_because || null);
    set_flag(this.handle_, "aria-valuetext", `${clock_text(shown_s)}, ${say("count")} ${Math.floor(count)}`);
    show_if(by_id("scrubbed"), scrub_s !== undefined);
    if (scrub_s !== undefined) set_text(by_id("scrubbed_at"), `${clock_text(scrub_s)}, ${say("count")} ${count_text(count)}.`);
    this.draw_line(shown_s);
  }

  private draw_time(now_ms: number): void {
    const { state } = this.model_;
    // Where a source of time is told, it is shown with its lock.
    const time = state?.time as { source?: string; state?: string; locked?: boolean; fps?: number } | undefined;
    set_text(by_id("timecode"), timecode_text(this.model_.clock.at(now_ms), Math.round(time?.fps ?? kFps)));
    const lock = time?.state ?? (time?.locked === false ? say("timecode_lost") : say("locked"));
    set_text(by_id("source"), `${time?.source ?? say("internal")}, ${lock}`);
  }

  private draw_line(shown_s: number): void {
    const { show, clock, scrub_s } = this.model_;
    if (!show) return;
    const ratio = devicePixelRatio;
    const width = Math.round(this.canvas_.clientWidth * ratio);
    const height = Math.round(this.canvas_.clientHeight * ratio);
    const span = span_of(show.cues);
    const x_of = (time_s: number) => Math.round(((time_s - span.from_s) / (span.to_s - span.from_s)) * (width - 16 * ratio) + 8 * ratio);
    const now_x = x_of(clock.at(performance.now()));
    const loop = this.model_.state?.loop;
    const drawn = [width, height, now_x, scrub_s === undefined ? "" : x_of(shown_s), loop?.from_s, loop?.to_s, document.documentElement.dataset.theme].join();
    if (drawn === this.drawn_ || width === 0) return;
    this.drawn_ = drawn;
    this.canvas_.width = width;
    this.canvas_.height = height;
    const context = this.canvas_.getContext("2d");
    if (!context) return;
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    context.font = `${13 * ratio}px sans-serif`;
    const bar = { top: 22 * ratio, high: height - 30 * ratio };
    show.sections.forEach((section, i) => {
      const from = x_of(section.start_s);
      const wide = Math.max(2, x_of(section.end_s) - from);
      context.fillStyle = colour(i % 2 ? "--line" : "--faint");
      context.globalAlpha = 0.55;
      context.fillRect(from, bar.top, wide, bar.high);
      context.globalAlpha = 1;
      context.fillStyle = colour("--ink");
      context.save();
      context.beginPath();
      context.rect(from, bar.top, wide, bar.high);
      context.clip();
      context.fillText(section.name, from + 4 * ratio, bar.top + bar.high / 2 + 5 * ratio);
      context.restore();
    });
    let free = -Infinity;
    for (const cue of show.cues) {
      const x = x_of(cue.from_s);
      context.fillStyle = colour("--mark");
      context.fillRect(x - ratio, 4 * ratio, 2 * ratio, height - 8 * ratio);
      if (x < free) continue;
      context.fillStyle = colour("--ink");
      context.fillText(cue.number, x + 4 * ratio, 14 * ratio);
      free = x + context.measureText(cue.number).width + 10 * ratio;
    }
    if (loop) {
      context.fillStyle = colour("--hold");
      context.fillRect(x_of(loop.from_s), height - 6 * ratio, x_of(loop.to_s) - x_of(loop.from_s), 5 * ratio);
    }
    context.fillStyle = colour("--go");
    context.fillRect(now_x - 3 * ratio, 0, 6 * ratio, height);
    if (scrub_s !== undefined) {
      context.strokeStyle = colour("--ink");
      context.lineWidth = 3 * ratio;
      context.setLineDash([6 * ratio, 4 * ratio]);
      context.strokeRect(x_of(shown_s) - 5 * ratio, 2 * ratio, 10 * ratio, height - 4 * ratio);
    }
  }
}
