// SPDX-License-Identifier: Apache-2.0
// Somebody's tracks on the GPU: the plan's, or those of a reset move.

import { ArrayTexture, buffer, type Gl, type Meter, per_instance } from "./gl";
import type { Tracks } from "./tracks";

export const kStretches = 4; // of the ways ahead

export class Crowd {
  readonly marks: ArrayTexture;
  /** One instance a performer, and one for each stretch of her way. */
  readonly people: WebGLVertexArrayObject | null;
  readonly ways: WebGLVertexArrayObject | null;
  private readonly track_: WebGLBuffer | null;

  /** @param who colour and flags of each performer */
  constructor(private readonly gl_: Gl, readonly tracks: Tracks, who: WebGLBuffer | null, meter: Meter) {
    const gl = gl_;
    const people = tracks.starts.length - 1;
    const track = new Uint32Array(2 * people); // first mark, how many
    for (let p = 0; p < people; ++p) {
      track[2 * p] = tracks.starts[p];
      track[2 * p + 1] = tracks.starts[p + 1] - tracks.starts[p];
    }
    this.marks = new ArrayTexture(gl, { internal: gl.RG32I, format: gl.RG_INTEGER, type: gl.INT, a_texel: 2 }, tracks.marks, meter);
    this.track_ = buffer(gl, track, meter);
    this.people = gl.createVertexArray();
    this.ways = gl.createVertexArray();
    for (const [vao, each] of [[this.people, 1], [this.ways, kStretches]] as const) {
      gl.bindVertexArray(vao);
      per_instance(gl, 0, this.track_, 2, gl.UNSIGNED_INT, each);
      per_instance(gl, 1, who, 2, gl.UNSIGNED_BYTE, each);
    }
    gl.bindVertexArray(null);
  }

  size(): number {
    return this.tracks.starts.length - 1;
  }

  free(): void {
    this.marks.free();
    this.gl_.deleteBuffer(this.track_);
    this.gl_.deleteVertexArray(this.people);
    this.gl_.deleteVertexArray(this.ways);
  }
}
