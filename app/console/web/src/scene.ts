// SPDX-License-Identifier: Apache-2.0
// The stage on the GPU. All of it is sent once; a frame sends a few numbers, and what nodes have confirmed since.

import type { View } from "./camera";
import { kLayers, kNoLayer } from "./floor_state";
import { Crowd, kStretches } from "./crowd";
import { ArrayTexture, buffer, type Gl, Meter, per_instance, Program } from "./gl";
import { group_table, look_table } from "./look_table";
import { kChannels, type Show } from "./protocol";
import * as shaders from "./shaders";
import type { Tracks } from "./tracks";

export interface Palette {
  ground: number[]; // 0..1
  line: number[];
  wing: number[];
  blocked: number[];
  edge: number[];
  selected: number[];
  wrong: number[];
  ink: number[];
}

/** What a frame shows. */
export interface Shown {
  view: View;
  size_px: { width: number; height: number }; // device pixels
  ratio: number; // device pixels of a CSS pixel
  time_ms: number; // where people stand
  ghosts_ms: number | undefined;
  ways_ms: number | undefined; // ways ahead, from now for so long
  people: boolean;
  lamps: boolean;
  planned: number; // layer of the looks that the plan wants; -1: what is confirmed
  selected: number; // performer, -1: nobody
  seconds: number; // for what blinks
  uses_way: boolean; // people walk the reset move
}

const kLegible_px = 2.5; // of a pitch: ways nearer to each other are a grey carpet
const kSlow_ms = 40; // a frame that takes more
const kFullTurn_m = 1.75; // a person's height

export class Scene {
  readonly meter = new Meter();
  private readonly gl_: Gl;
  private readonly cells_: Program;
  private readonly lamps_: Program;
  private readonly people_: Program;
  private readonly ways_: Program;
  private centres_?: ArrayTexture;
  private looks_: WebGLTexture | null = null;
  private groups_: WebGLTexture | null = null;
  private nodes_: WebGLTexture | null = null;
  private layers_: WebGLTexture | null = null;
  private floor_vao_: WebGLVertexArrayObject | null = null;
  private lamp_vao_: WebGLVertexArrayObject | null = null;
  private who_: WebGLBuffer | null = null;
  private plan_?: Crowd;
  private way_?: Crowd;
  private show_?: Show;
  private cells_many_ = 0;
  private flagged_ = false; // there are wings or blocked cells
  private lamps_many_ = 0;
  private node_rows_ = 1;
  private layer_rows_ = 1;
  private last_frame_: WebGLSync | null = null;
  private began_ms_ = 0; // of the frame that the GPU draws
  private rests_until_ms_ = 0;

  constructor(canvas: HTMLCanvasElement, private palette_: Palette) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.gl_ = gl;
    this.cells_ = new Program(gl, shaders.cells_vertex, shaders.cells_fragment, ["flags"]);
    this.lamps_ = new Program(gl, shaders.lamps_vertex, shaders.lamps_fragment, ["lamp"]);
    this.people_ = new Program(gl, shaders.people_vertex, shaders.people_fragment, ["track", "who"]);
    this.ways_ = new Program(gl, shaders.ways_vertex, shaders.ways_fragment, ["track", "who"]);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  set palette(palette: Palette) {
    this.palette_ = palette;
  }

  /** @param lamps cell and channel of each  @param who colour and flags of each performer */
  take_show(show: Show, centres: Float32Array, tracks: Tracks, flags: Uint8Array, lamps: Uint32Array, who: Uint8Array): void {
    const gl = this.gl_;
    this.free();
    this.show_ = show;
    this.cells_many_ = centres.length / 2;
    this.flagged_ = show.stage.wings.length + show.stage.blocked.length > 0;
    this.centres_ = new ArrayTexture(gl, { internal: gl.RG32F, format: gl.RG, type: gl.FLOAT, a_texel: 2 }, centres, this.meter);
    this.looks_ = this.small(256, 1, gl.RGBA8, look_table(show));
    this.groups_ = this.small(256, 1, gl.RGBA8, group_table(show));
    this.node_rows_ = Math.max(1, Math.ceil(show.rig.length / ArrayTexture.kTexels));
    this.nodes_ = this.small(ArrayTexture.kTexels, this.node_rows_, gl.RG8UI, undefined);
    this.layer_rows_ = Math.max(1, Math.ceil((show.rig.length * kChannels) / ArrayTexture.kTexels));
    this.layers_ = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.layers_);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D_ARRAY, side, gl.NEAREST);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.R8UI, ArrayTexture.kTexels, this.layer_rows_, kLayers);
    this.floor_vao_ = gl.createVertexArray();
    gl.bindVertexArray(this.floor_vao_);
    per_instance(gl, 0, buffer(gl, flags, this.meter), 1, gl.UNSIGNED_BYTE);
    this.lamp_vao_ = gl.createVertexArray();
    gl.bindVertexArray(this.lamp_vao_);
    per_instance(gl, 0, buffer(gl, lamps, this.meter), 2, gl.UNSIGNED_INT);
    this.lamps_many_ = lamps.length / 2;
    this.who_ = buffer(gl, who, this.meter, gl.DYNAMIC_DRAW);
    this.plan_ = new Crowd(gl, tracks, this.who_, this.meter);
  }

  /** The reset move; undefined: there is none. */
  take_way(tracks: Tracks | undefined): void {
    this.way_?.free();
    this.way_ = tracks ? new Crowd(this.gl_, tracks, this.who_, this.meter) : undefined;
  }

  /** Colour and flags of one performer. */
  mark_performer(performer: number, colour: number, flags: number): void {
    if (performer < 0 || !this.who_) return;
    this.gl_.bindBuffer(this.gl_.ARRAY_BUFFER, this.who_);
    this.gl_.bufferSubData(this.gl_.ARRAY_BUFFER, 2 * performer, new Uint8Array([colour, flags]));
    this.meter.bytes += 2;
  }

  /** Looks of all channels at a switch. */
  take_looks(layer: number, looks: Uint8Array): void {
    const gl = this.gl_;
    const whole = new Uint8Array(ArrayTexture.kTexels * this.layer_rows_);
    whole.set(looks.subarray(0, whole.length));
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.layers_);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, layer, ArrayTexture.kTexels, this.layer_rows_, 1, gl.RED_INTEGER, gl.UNSIGNED_BYTE, whole);
    this.meter.bytes += whole.length;
  }

  /** @param state layer and drawn state of each node */
  take_nodes(state: Uint8Array): void {
    const gl = this.gl_;
    const whole = new Uint8Array(2 * ArrayTexture.kTexels * this.node_rows_).fill(kNoLayer);
    whole.set(state);
    gl.bindTexture(gl.TEXTURE_2D, this.nodes_);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ArrayTexture.kTexels, this.node_rows_, gl.RG_INTEGER, gl.UNSIGNED_BYTE, whole);
    this.meter.bytes += whole.length;
  }

  /**
   * The GPU is not done with the last frame: another one would only make the page wait. One that is slow (a processor
   * that draws) rests as long as it has drawn: the show's own threads may be on the same machine.
   */
  busy(now_ms: number): boolean {
    const gl = this.gl_;
    if (!this.last_frame_) return now_ms < this.rests_until_ms_;
    if (gl.getSyncParameter(this.last_frame_, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost()) return true;
    gl.deleteSync(this.last_frame_);
    this.last_frame_ = null;
    const took_ms = now_ms - this.began_ms_;
    this.rests_until_ms_ = took_ms > kSlow_ms ? now_ms + took_ms : 0;
    return now_ms < this.rests_until_ms_;
  }

  /** @return whether everything that was taken is on the GPU; until then nothing of the floor is drawn */
  draw(shown: Shown, now_ms: number): boolean {
    const gl = this.gl_;
    this.began_ms_ = now_ms;
    const ground = this.palette_.ground;
    gl.viewport(0, 0, shown.size_px.width, shown.size_px.height);
    gl.clearColor(ground[0], ground[1], ground[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!this.show_ || !this.centres_ || !this.plan_) return true;
    if (!this.centres_.fill()) return false;
    if (!this.plan_.marks.fill()) return false;
    const way_is_here = this.way_ ? this.way_.marks.fill() : true;
    const cell_px = 0.5 * shown.view.focal_px * shown.ratio * this.show_.stage.pitch_m;
    if (this.flagged_ || cell_px > 2 || shown.view.front) this.draw_cells(shown);
    if (shown.lamps && this.lamps_many_ > 0) this.draw_lamps(shown);
    const walking = shown.uses_way && this.way_ && way_is_here ? this.way_ : this.plan_;
    const legible = shown.view.focal_px * this.show_.stage.pitch_m >= kLegible_px || shown.view.front;
    if (shown.ways_ms !== undefined && legible) this.draw_ways(shown, walking, shown.time_ms, shown.time_ms + shown.ways_ms, kStretches);
    if (shown.ghosts_ms !== undefined) this.draw_people(shown, this.plan_, shown.ghosts_ms, true);
    if (shown.selected >= 0) this.draw_whole_way(shown, this.plan_);
    if (shown.people) this.draw_people(shown, walking, shown.time_ms, false);
    this.last_frame_ = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    return way_is_here;
  }

  private draw_cells(shown: Shown): void {
    const gl = this.gl_;
    const show = this.show_ as Show;
    const kind = show.stage.grid;
    const half = { square: 0.5, hexagonal: 1 / Math.sqrt(3), triangular: 1 }[kind] * show.stage.pitch_m;
    this.use(this.cells_, shown);
    gl.uniform1f(this.cells_.at("half_m"), half);
    gl.uniform1i(this.cells_.at("shape"), { square: 4, hexagonal: 6, triangular: 3 }[kind]);
    for (const name of ["line", "wing", "blocked"] as const) gl.uniform3fv(this.cells_.at(name), this.palette_[name]);
    gl.bindVertexArray(this.floor_vao_);
    this.instances(this.cells_many_);
  }

  private draw_lamps(shown: Shown): void {
    const gl = this.gl_;
    this.use(this.lamps_, shown);
    this.bind_texture(this.lamps_, "nodes", 2, gl.TEXTURE_2D, this.nodes_);
    this.bind_texture(this.lamps_, "shown", 3, gl.TEXTURE_2D_ARRAY, this.layers_);
    this.bind_texture(this.lamps_, "looks", 4, gl.TEXTURE_2D, this.looks_);
    gl.uniform1i(this.lamps_.at("planned"), shown.planned);
    gl.uniform1f(this.lamps_.at("half_m"), 0.43 * (this.show_ as Show).stage.pitch_m);
    gl.uniform1f(this.lamps_.at("least_px"), 1.5 * shown.ratio);
    gl.uniform1f(this.lamps_.at("seconds"), shown.seconds);
    gl.uniform3fv(this.lamps_.at("wrong"), this.palette_.wrong);
    gl.uniform3fv(this.lamps_.at("ink"), this.palette_.ink);
    gl.bindVertexArray(this.lamp_vao_);
    this.instances(this.lamps_many_);
  }

  private draw_people(shown: Shown, crowd: Crowd, time_ms: number, ghosts: boolean): void {
    const gl = this.gl_;
    const program = this.people_;
    this.use(program, shown);
    this.bind_crowd(program, crowd);
    gl.uniform1i(program.at("time_ms"), time_ms);
    gl.uniform1i(program.at("now_ms"), shown.time_ms);
    gl.uniform1i(program.at("ghost"), ghosts ? 1 : 0);
    gl.uniform1f(program.at("radius_m"), (ghosts ? 0.36 : 0.3) * Math.min(1, (this.show_ as Show).stage.pitch_m));
    gl.uniform1f(program.at("least_px"), 1.6 * shown.ratio);
    gl.uniform1f(program.at("stand_m"), shown.view.front && !ghosts ? kFullTurn_m : 0);
    gl.uniform1f(program.at("seconds"), shown.seconds);
    gl.uniform3fv(program.at("edge_colour"), this.palette_.edge);
    gl.uniform3fv(program.at("selected"), this.palette_.selected);
    gl.bindVertexArray(crowd.people);
    this.instances(crowd.size());
  }

  private draw_ways(shown: Shown, crowd: Crowd, from_ms: number, until_ms: number, stretches: number): void {
    const gl = this.gl_;
    this.use_ways(shown, crowd, from_ms, until_ms, stretches);
    gl.uniform1f(this.ways_.at("width_px"), 1.1 * shown.ratio);
    gl.uniform1f(this.ways_.at("alpha"), 0.75);
    gl.uniform1f(this.ways_.at("dash_px"), 0);
    gl.uniform4f(this.ways_.at("ink"), 0, 0, 0, 0);
    gl.bindVertexArray(crowd.ways);
    this.instances(crowd.size() * stretches);
  }

  /** Dashed where she has been, whole where she will go. */
  private draw_whole_way(shown: Shown, crowd: Crowd): void {
    const gl = this.gl_;
    const first = crowd.tracks.starts[shown.selected];
    const many = crowd.tracks.starts[shown.selected + 1] - first;
    const ink = this.palette_.selected;
    gl.bindVertexArray(null);
    gl.vertexAttribI4ui(0, first, many, 0, 0);
    gl.vertexAttribI4ui(1, 0, 0, 0, 0);
    for (const [from, until, dash, alpha] of [[-0x7fffffff, shown.time_ms, 7, 0.6], [shown.time_ms, 0x7fffffff, 0, 1]]) {
      this.use_ways(shown, crowd, from, until, many);
      gl.uniform1f(this.ways_.at("width_px"), 1.8 * shown.ratio);
      gl.uniform1f(this.ways_.at("alpha"), alpha * 3); // does not fade along the way
      gl.uniform1f(this.ways_.at("dash_px"), dash * shown.ratio);
      gl.uniform4f(this.ways_.at("ink"), ink[0], ink[1], ink[2], 1);
      this.instances(many);
    }
  }

  private use_ways(shown: Shown, crowd: Crowd, from_ms: number, until_ms: number, stretches: number): void {
    this.use(this.ways_, shown);
    this.bind_crowd(this.ways_, crowd);
    this.gl_.uniform1i(this.ways_.at("stretches"), stretches);
    this.gl_.uniform1i(this.ways_.at("from_ms"), from_ms);
    this.gl_.uniform1i(this.ways_.at("until_ms"), until_ms);
  }

  private use(program: Program, shown: Shown): void {
    const gl = this.gl_;
    gl.useProgram(program.handle);
    gl.uniformMatrix4fv(program.at("view"), false, shown.view.matrix);
    gl.uniform2f(program.at("viewport"), shown.size_px.width, shown.size_px.height);
    gl.uniform1f(program.at("focal"), shown.view.focal_px * shown.ratio);
    this.bind_texture(program, "centres", 1, gl.TEXTURE_2D, (this.centres_ as ArrayTexture).handle);
    this.meter.bytes += 80;
  }

  private bind_crowd(program: Program, crowd: Crowd): void {
    this.bind_texture(program, "marks", 0, this.gl_.TEXTURE_2D, crowd.marks.handle);
    this.bind_texture(program, "groups", 2, this.gl_.TEXTURE_2D, this.groups_);
  }

  private bind_texture(program: Program, name: string, unit: number, target: number, texture: WebGLTexture | null): void {
    this.gl_.activeTexture(this.gl_.TEXTURE0 + unit);
    this.gl_.bindTexture(target, texture);
    this.gl_.uniform1i(program.at(name), unit);
  }

  private instances(many: number): void {
    this.gl_.drawArraysInstanced(this.gl_.TRIANGLE_STRIP, 0, 4, many);
    ++this.meter.draws;
    this.meter.bytes += 32;
  }

  private small(width: number, height: number, internal: number, data: Uint8Array | undefined): WebGLTexture | null {
    const gl = this.gl_;
    const handle = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, handle);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
    gl.texStorage2D(gl.TEXTURE_2D, 1, internal, width, height);
    if (data) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    return handle;
  }

  private free(): void {
    const gl = this.gl_;
    this.take_way(undefined);
    this.plan_?.free();
    this.centres_?.free();
    for (const texture of [this.looks_, this.groups_, this.nodes_, this.layers_]) gl.deleteTexture(texture);
    gl.deleteVertexArray(this.floor_vao_);
    gl.deleteVertexArray(this.lamp_vao_);
    gl.deleteBuffer(this.who_);
  }
}
