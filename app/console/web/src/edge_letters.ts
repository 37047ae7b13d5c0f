// SPDX-License-Identifier: Apache-2.0
// Letters and numbers of the grid along the edges of the stage, and where the audience is.

import type { Camera } from "./camera";
import { column_letters } from "./cell_name";
import { cell_from } from "./find";
import type { Model } from "./model";
import type { Show } from "./protocol";
import type { Point } from "./tracks";
import { say } from "./words";

/** So many apart that names do not touch. */
function steps(camera: Camera, many: number, place: (i: number) => number, across: boolean): number {
  if (many < 2) return 1;
  const a = camera.project(across ? { x: place(0), y: 0 } : { x: 0, y: place(0) });
  const b = camera.project(across ? { x: place(many - 1), y: 0 } : { x: 0, y: place(many - 1) });
  const apart = Math.hypot(b.x - a.x, b.y - a.y) / (many - 1);
  return [1, 2, 5, 10, 20, 50, 100].find((step) => step * apart >= (across ? 24 : 16)) ?? 200;
}

export class EdgeLetters {
  private drawn_ = "";

  constructor(private readonly canvas_: HTMLCanvasElement) {}

  redraw(): void {
    this.drawn_ = "";
  }

  draw(model: Model, camera: Camera): void {
    const { show, centres } = model;
    if (!show || centres.length === 0) return;
    const asked = cell_from(model.state?.question?.cell ?? "", show.stage.columns, show.stage.rows);
    const drawn = [asked, camera.view().matrix.join(), camera.size.width, camera.size.height, document.documentElement.dataset.theme, document.documentElement.lang].join("|");
    if (drawn === this.drawn_) return;
    this.drawn_ = drawn;
    const context = this.canvas_.getContext("2d");
    if (!context) return;
    const ratio = devicePixelRatio;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, camera.size.width, camera.size.height);
    context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--ink");
    context.font = "12px sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    this.columns(context, show, centres, camera);
    this.rows(context, show, centres, camera);
    if (asked !== undefined) this.ring(context, camera.project({ x: centres[2 * asked], y: centres[2 * asked + 1] }));
    if (camera.front) return;
    const { columns, rows, pitch_m } = show.stage;
    const first = { x: centres[0], y: centres[1] };
    const last = { x: centres[2 * (columns - 1)], y: centres[2 * (columns * rows - 1) + 1] };
    const write = (text: string, at: Point, dx: number, dy: number, turn = 0) => {
      const p = camera.project(at);
      context.save();
      context.translate(p.x + dx, p.y + dy);
      context.rotate(turn);
      context.fillText(text, 0, 0);
      context.restore();
    };
    context.font = "bold 14px sans-serif";
    write(say("audience"), { x: (first.x + last.x) / 2, y: first.y - 0.5 * pitch_m }, 0, 34);
    context.font = "13px sans-serif";
    write(say("stage_right"), { x: first.x - 0.5 * pitch_m, y: (first.y + last.y) / 2 }, -38, 0, -Math.PI / 2);
    write(say("stage_left"), { x: last.x + 0.5 * pitch_m, y: (first.y + last.y) / 2 }, 38, 0, Math.PI / 2);
  }

  /** Around a lamp that somebody has to look at. */
  private ring(context: CanvasRenderingContext2D, at: Point): void {
    context.save();
    context.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue("--hold");
    context.lineWidth = 4;
    for (const radius of [14, 24]) {
      context.beginPath();
      context.arc(at.x, at.y, radius, 0, 2 * Math.PI);
      context.stroke();
    }
    context.restore();
  }

  /** Letters where they stay in sight, as many as there is room for. */
  private columns(context: CanvasRenderingContext2D, show: Show, centres: Float32Array, camera: Camera): void {
    const { columns, rows, pitch_m } = show.stage;
    const step = steps(camera, columns, (i) => centres[2 * i], true);
    for (let column = 0; column < columns; column += step) {
      for (const [row, side] of [[0, 1], [rows - 1, -1]]) {
        if (camera.front && side < 0) continue;
        const cell = row * columns + column;
        const p = camera.project({ x: centres[2 * column], y: centres[2 * cell + 1] - side * 0.5 * pitch_m });
        context.fillText(column_letters(column), p.x, Math.min(camera.size.height - 10, Math.max(10, p.y + side * 13)));
      }
    }
  }

  private rows(context: CanvasRenderingContext2D, show: Show, centres: Float32Array, camera: Camera): void {
    const { columns, rows, pitch_m } = show.stage;
    const step = steps(camera, rows, (i) => centres[2 * i * columns + 1], false);
    // 1, 5, 10: round numbers are found without counting.
    for (let row = 0; row < rows; row += row === 0 && step >= 5 ? step - 1 : step) {
      for (const [column, side] of [[0, -1], [columns - 1, 1]]) {
        const cell = row * columns + column;
        const p = camera.project({ x: centres[2 * cell] + side * 0.5 * pitch_m, y: centres[2 * cell + 1] });
        context.fillText(String(row + 1), Math.min(camera.size.width - 14, Math.max(14, p.x + side * 16)), p.y);
      }
    }
  }
}
