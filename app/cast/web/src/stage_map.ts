// SPDX-License-Identifier: Apache-2.0
// The stage as a performer sees it, audience above: a tap says where somebody is.

import { column_letters } from "../../../console/web/src/cell_name";
import { centres_of, type Show } from "../../../console/web/src/protocol";

type Stage = Show["stage"];

export class StageMap {
  private centres_: Float32Array = new Float32Array();
  private stage_?: Stage;
  private scale_ = 1;
  private left_ = 0;
  private top_ = 0;

  constructor(private readonly canvas_: HTMLCanvasElement, private readonly picked_: (cell: number) => void) {
    canvas_.addEventListener("click", (event) => {
      const box = canvas_.getBoundingClientRect();
      const cell = this.cell_near(event.clientX - box.left, event.clientY - box.top);
      if (cell >= 0) this.picked_(cell);
    });
  }

  take(stage: Stage): void {
    this.stage_ = stage;
    this.centres_ = centres_of(stage);
  }

  /** Of a cell, m. */
  centre(cell: number): { x: number; y: number } {
    return { x: this.centres_[2 * cell], y: this.centres_[2 * cell + 1] };
  }

  /** The cell whose centre is nearest, by m on the stage. */
  nearest(x: number, y: number): number {
    let found = -1;
    let least = Infinity;
    for (let cell = 0; 2 * cell < this.centres_.length; ++cell) {
      const squared = (this.centres_[2 * cell] - x) ** 2 + (this.centres_[2 * cell + 1] - y) ** 2;
      if (squared < least) {
        least = squared;
        found = cell;
      }
    }
    return found;
  }

  private cell_near(left: number, top: number): number {
    return this.stage_ ? this.nearest(-(left - this.left_) / this.scale_, (top - this.top_) / this.scale_) : -1;
  }

  /** @param here where she says that she is  @param goal where she should be  @param way cells to go by */
  draw(here: number, goal: number, way: number[]): void {
    const stage = this.stage_;
    const width = this.canvas_.clientWidth;
    const height = this.canvas_.clientHeight;
    const context = this.canvas_.getContext("2d");
    if (!stage || !context || width === 0) return;
    const ratio = window.devicePixelRatio || 1;
    this.canvas_.width = width * ratio;
    this.canvas_.height = height * ratio;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    const pitch = stage.pitch_m;
    let [low_x, high_x, low_y, high_y] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let i = 0; i < this.centres_.length; i += 2) {
      low_x = Math.min(low_x, this.centres_[i]);
      high_x = Math.max(high_x, this.centres_[i]);
      low_y = Math.min(low_y, this.centres_[i + 1]);
      high_y = Math.max(high_y, this.centres_[i + 1]);
    }
    const margin = 22;
    this.scale_ = Math.min((width - 2 * margin) / (high_x - low_x + pitch), (height - 2 * margin) / (high_y - low_y + pitch));
    this.left_ = width / 2 + ((low_x + high_x) / 2) * this.scale_;
    this.top_ = margin + (pitch / 2 - low_y) * this.scale_;
    const at = (cell: number) => ({ x: this.left_ - this.centres_[2 * cell] * this.scale_, y: this.top_ + this.centres_[2 * cell + 1] * this.scale_ });
    const side = Math.max(1, pitch * this.scale_ - 1);
    context.fillStyle = colour("--line");
    for (let cell = 0; cell < stage.columns * stage.rows; ++cell) context.fillRect(at(cell).x - side / 2, at(cell).y - side / 2, side, side);
    context.fillStyle = colour("--panel");
    for (const cell of stage.wings) context.fillRect(at(cell).x - side / 2, at(cell).y - side / 2, side, side);
    context.fillStyle = colour("--faint");
    for (const cell of stage.blocked) context.fillRect(at(cell).x - side / 2, at(cell).y - side / 2, side, side);
    this.letters(context, colour("--ink"), at);
    context.strokeStyle = context.fillStyle = colour("--go");
    context.lineWidth = 4;
    context.beginPath();
    [here, ...way].filter((cell) => cell >= 0).forEach((cell, k) => (k === 0 ? context.moveTo(at(cell).x, at(cell).y) : context.lineTo(at(cell).x, at(cell).y)));
    context.stroke();
    const dot = (cell: number, radius: number, full: boolean, name: string) => {
      context.strokeStyle = context.fillStyle = colour(name);
      context.beginPath();
      context.arc(at(cell).x, at(cell).y, radius, 0, 2 * Math.PI);
      if (full) context.fill();
      else context.stroke();
    };
    if (goal >= 0) dot(goal, Math.max(9, side / 2), false, "--mark");
    if (here >= 0) dot(here, Math.max(7, side / 2), true, "--ink");
  }

  private letters(context: CanvasRenderingContext2D, ink: string, at: (cell: number) => { x: number; y: number }): void {
    const stage = this.stage_ as Stage;
    context.fillStyle = ink;
    context.font = "12px sans-serif";
    context.textAlign = "center";
    const room_px = 28;
    const step_of = (count: number, length_px: number) => {
      const least = (count * room_px) / Math.max(1, length_px);
      return [1, 2, 5, 10, 20, 50, 100].find((one) => one >= least) || 200;
    };
    const first = at(0);
    const last = at(stage.columns * stage.rows - 1);
    const columns = step_of(stage.columns, Math.abs(first.x - last.x));
    for (let column = 0; column < stage.columns; column += columns) context.fillText(column_letters(column), at(column).x, 13);
    const rows = step_of(stage.rows, Math.abs(first.y - last.y) * 1.5);
    for (let row = 0; row < stage.rows; row += rows) {
      context.fillText(String(row + 1), Math.max(11, last.x - 14 < first.x ? last.x - 14 : 11), at(row * stage.columns).y + 4);
    }
  }
}
