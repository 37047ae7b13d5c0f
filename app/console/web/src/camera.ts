// SPDX-License-Identifier: Apache-2.0
// The stage from above, and from the audience in perspective. Pure: matrices are 16 numbers by columns, as WebGL takes them.

import type { Point } from "./tracks";

export interface Box {
  low: Point;
  high: Point;
}

export interface Size {
  width: number; // CSS pixels
  height: number;
}

export interface View {
  matrix: Float32Array; // stage metres to clip space
  focal_px: number; // pixels of a metre where w is 1
  front: boolean;
}

const kEdge_px = { x: 60, y: 48 }; // of letters around the stage
const kEye_m = 1.7; // a person's
const kRise = 0.5; // of the seats: height gained for each metre away

/** What is looked at. Above: pixels a metre and the middle; in front: the same framing as a lens. */
export class Camera {
  front = false;
  size: Size = { width: 1, height: 1 };
  private box_: Box = { low: { x: 0, y: 0 }, high: { x: 1, y: 1 } };
  private zoom_ = 1; // 1: everything is seen
  private middle_: Point = { x: 0, y: 0 };

  fit(box: Box): void {
    this.box_ = box;
    this.reset();
  }

  reset(): void {
    this.zoom_ = 1;
    this.middle_ = { x: (this.box_.low.x + this.box_.high.x) / 2, y: (this.box_.low.y + this.box_.high.y) / 2 };
  }

  /** Pixels a metre, from above. */
  scale(): number {
    const width = this.box_.high.x - this.box_.low.x;
    const height = this.box_.high.y - this.box_.low.y;
    return this.zoom_ * Math.min(this.room().width / width, this.room().height / height);
  }

  private room(): Size {
    return { width: Math.max(1, this.size.width - 2 * kEdge_px.x), height: Math.max(1, this.size.height - 2 * kEdge_px.y) };
  }

  view(): View {
    return this.front ? this.from_the_audience() : this.from_above();
  }

  private from_above(): View {
    const scale = this.scale();
    const a = (2 * scale) / this.size.width;
    const b = (2 * scale) / this.size.height;
    // Upstage is up, and the audience's right is stage left.
    const matrix = new Float32Array([a, 0, 0, 0, 0, b, 0, 0, 0, 0, 0, 0, -a * this.middle_.x, -b * this.middle_.y, 0, 1]);
    return { matrix, focal_px: scale, front: false };
  }

  private from_the_audience(): View {
    const width = this.box_.high.x - this.box_.low.x;
    const depth = this.box_.high.y - this.box_.low.y;
    const away = 0.6 * Math.max(width, depth);
    const eye = { x: 0.5 * (this.box_.low.x + this.box_.high.x), y: this.box_.low.y - away, z: kEye_m + kRise * away };
    const aim = { x: this.middle_.x, y: this.middle_.y - 0.1 * depth, z: 0 };
    const ahead = unit({ x: aim.x - eye.x, y: aim.y - eye.y, z: aim.z - eye.z });
    const right = unit({ x: ahead.y, y: -ahead.x, z: 0 });
    const up = cross(right, ahead);
    // As large as the floor and the heads on it fit; in the middle.
    const seen = { left: Infinity, right: -Infinity, low: Infinity, high: -Infinity };
    for (const x of [this.box_.low.x, this.box_.high.x]) {
      for (const [y, z] of [[this.box_.low.y, 0], [this.box_.high.y, 0], [this.box_.high.y, kEye_m]]) {
        const from_eye = { x: x - eye.x, y: y - eye.y, z: z - eye.z };
        const w = dot(ahead, from_eye);
        seen.left = Math.min(seen.left, dot(right, from_eye) / w);
        seen.right = Math.max(seen.right, dot(right, from_eye) / w);
        seen.low = Math.min(seen.low, dot(up, from_eye) / w);
        seen.high = Math.max(seen.high, dot(up, from_eye) / w);
      }
    }
    const focal = this.zoom_ * Math.min(this.room().width / (seen.right - seen.left), this.room().height / (seen.high - seen.low));
    const a = (2 * focal) / this.size.width;
    const b = (2 * focal) / this.size.height;
    const middle = this.zoom_ === 1 ? { x: (a * (seen.left + seen.right)) / 2, y: (b * (seen.low + seen.high)) / 2 } : { x: 0, y: 0 };
    const nearest = dot(ahead, { x: 0, y: this.box_.low.y - eye.y, z: -eye.z });
    const far = nearest + 4 * depth + away;
    const near = 0.1 * nearest;
    const c = (far + near) / (far - near);
    const d = (-2 * far * near) / (far - near);
    const rows = [
      [a * right.x, a * right.y, a * right.z, -a * dot(right, eye)],
      [b * up.x, b * up.y, b * up.z, -b * dot(up, eye)],
      [c * ahead.x, c * ahead.y, c * ahead.z, d - c * dot(ahead, eye)],
      [ahead.x, ahead.y, ahead.z, -dot(ahead, eye)],
    ];
    // The middle of what is seen is the middle of the picture.
    for (let k = 0; k < 4; ++k) {
      rows[0][k] -= middle.x * rows[3][k];
      rows[1][k] -= middle.y * rows[3][k];
    }
    const matrix = new Float32Array(16);
    for (let r = 0; r < 4; ++r) for (let k = 0; k < 4; ++k) matrix[4 * k + r] = rows[r][k];
    return { matrix, focal_px: focal, front: true };
  }

  /** CSS pixels from the upper left corner; `scale` pixels a metre there. */
  project(at: Point, z = 0): { x: number; y: number; scale: number } {
    const { matrix: m, focal_px } = this.view();
    const row = (r: number) => m[r] * at.x + m[4 + r] * at.y + m[8 + r] * z + m[12 + r];
    const w = row(3);
    return { x: (0.5 + (0.5 * row(0)) / w) * this.size.width, y: (0.5 - (0.5 * row(1)) / w) * this.size.height, scale: focal_px / w };
  }

  /** The place on the floor under a pixel. */
  unproject(x: number, y: number): Point {
    const { matrix: m } = this.view();
    const u = (2 * x) / this.size.width - 1;
    const v = 1 - (2 * y) / this.size.height;
    // Two equations: (row 0 - u row 3) p = 0, (row 1 - v row 3) p = 0, with z = 0.
    const e = [m[0] - u * m[3], m[4] - u * m[7], -(m[12] - u * m[15])];
    const f = [m[1] - v * m[3], m[5] - v * m[7], -(m[13] - v * m[15])];
    const determinant = e[0] * f[1] - e[1] * f[0];
    return { x: (e[2] * f[1] - e[1] * f[2]) / determinant, y: (e[0] * f[2] - e[2] * f[0]) / determinant };
  }

  /** What is under the pixel stays there. */
  zoom(factor: number, x: number, y: number): void {
    const before = this.unproject(x, y);
    this.zoom_ = Math.min(60, Math.max(0.5, this.zoom_ * factor));
    this.keep(before, x, y);
  }

  pan(from_x: number, from_y: number, to_x: number, to_y: number): void {
    this.keep(this.unproject(from_x, from_y), to_x, to_y);
  }

  private keep(place: Point, x: number, y: number): void {
    const now = this.unproject(x, y);
    const inside = (value: number, low: number, high: number) => Math.min(high, Math.max(low, value));
    this.middle_ = {
      x: inside(this.middle_.x + place.x - now.x, this.box_.low.x, this.box_.high.x),
      y: inside(this.middle_.y + place.y - now.y, this.box_.low.y, this.box_.high.y),
    };
  }
}

interface Vector {
  x: number;
  y: number;
  z: number;
}

function dot(a: Vector, b: Vector): number {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

function cross(a: Vector, b: Vector): Vector {
  return { x: a.y * b.z - a.z * b.y, y: a.z * b.x - a.x * b.z, z: a.x * b.y - a.y * b.x };
}

function unit(a: Vector): Vector {
  const length = Math.sqrt(dot(a, a));
  return { x: a.x / length, y: a.y / length, z: a.z / length };
}
