// SPDX-License-Identifier: Apache-2.0
// A thin layer over WebGL 2: programs, textures that fill over several frames, and what a frame costs.

/** Draw calls and bytes sent to the GPU since the last `take`. */
export class Meter {
  draws = 0;
  bytes = 0;
  take(): { draws: number; bytes: number } {
    const taken = { draws: this.draws, bytes: this.bytes };
    this.draws = 0;
    this.bytes = 0;
    return taken;
  }
}

export type Gl = WebGL2RenderingContext;

export class Program {
  readonly handle: WebGLProgram;
  private readonly places_ = new Map<string, WebGLUniformLocation | null>();

  /** @param attributes names by location */
  constructor(private readonly gl_: Gl, vertex: string, fragment: string, attributes: string[]) {
    const handle = gl_.createProgram();
    if (!handle) throw new Error("WebGL: no program");
    for (const [kind, source] of [[gl_.VERTEX_SHADER, vertex], [gl_.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl_.createShader(kind);
      if (!shader) throw new Error("WebGL: no shader");
      gl_.shaderSource(shader, source);
      gl_.compileShader(shader);
      gl_.attachShader(handle, shader);
      if (!gl_.getShaderParameter(shader, gl_.COMPILE_STATUS) && !gl_.isContextLost()) {
        throw new Error(`WebGL: ${gl_.getShaderInfoLog(shader)}`);
      }
    }
    attributes.forEach((name, location) => gl_.bindAttribLocation(handle, location, name));
    gl_.linkProgram(handle);
    if (!gl_.getProgramParameter(handle, gl_.LINK_STATUS) && !gl_.isContextLost()) {
      throw new Error(`WebGL: ${gl_.getProgramInfoLog(handle)}`);
    }
    this.handle = handle;
  }

  at(name: string): WebGLUniformLocation | null {
    let place = this.places_.get(name);
    if (place === undefined) {
      place = this.gl_.getUniformLocation(this.handle, name);
      this.places_.set(name, place);
    }
    return place;
  }
}

type Numbers = Int32Array | Uint32Array | Float32Array | Uint8Array;

const kWidth = 2048; // texels; every WebGL 2 has as many
const kBytesAFrame = 4 << 20; // of filling

/** A long array as a texture with rows of `kTexels`; it is filled a piece a frame, so that no frame takes long. */
export class ArrayTexture {
  static readonly kTexels = kWidth;
  readonly handle: WebGLTexture | null;
  private row_ = 0;
  private readonly rows_: number;
  private readonly rest_: Numbers;

  /** @param a_texel numbers in one; the array may end within a row */
  constructor(private readonly gl_: Gl, private readonly format_: { internal: number; format: number; type: number; a_texel: number },
              private readonly data_: Numbers, private readonly meter_: Meter) {
    const a_row = kWidth * format_.a_texel;
    this.rows_ = Math.max(1, Math.ceil(data_.length / a_row));
    const last = data_.subarray((this.rows_ - 1) * a_row);
    this.rest_ = new (data_.constructor as new (length: number) => Numbers)(a_row);
    this.rest_.set(last);
    this.handle = gl_.createTexture();
    gl_.bindTexture(gl_.TEXTURE_2D, this.handle);
    for (const side of [gl_.TEXTURE_MIN_FILTER, gl_.TEXTURE_MAG_FILTER]) gl_.texParameteri(gl_.TEXTURE_2D, side, gl_.NEAREST);
    gl_.texStorage2D(gl_.TEXTURE_2D, 1, format_.internal, kWidth, this.rows_);
  }

  /** Goes on filling. @return whether all of it is there */
  fill(): boolean {
    if (this.row_ >= this.rows_) return true;
    const a_row = kWidth * this.format_.a_texel;
    const bytes = a_row * this.data_.BYTES_PER_ELEMENT;
    const whole = Math.min(this.rows_ - 1 - this.row_, Math.max(1, Math.floor(kBytesAFrame / bytes)));
    const rows = Math.max(1, whole);
    const piece = whole > 0 ? this.data_.subarray(this.row_ * a_row, (this.row_ + rows) * a_row) : this.rest_;
    this.gl_.bindTexture(this.gl_.TEXTURE_2D, this.handle);
    this.gl_.pixelStorei(this.gl_.UNPACK_ALIGNMENT, 1);
    this.gl_.texSubImage2D(this.gl_.TEXTURE_2D, 0, 0, this.row_, kWidth, rows, this.format_.format, this.format_.type, piece);
    this.meter_.bytes += rows * bytes;
    this.row_ += rows;
    return this.row_ >= this.rows_;
  }

  bind(unit: number): void {
    this.gl_.activeTexture(this.gl_.TEXTURE0 + unit);
    this.gl_.bindTexture(this.gl_.TEXTURE_2D, this.handle);
  }

  free(): void {
    this.gl_.deleteTexture(this.handle);
  }
}

/** A buffer of the GPU. */
export function buffer(gl: Gl, data: Numbers, meter: Meter, usage: number = gl.STATIC_DRAW): WebGLBuffer | null {
  const handle = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, handle);
  gl.bufferData(gl.ARRAY_BUFFER, data, usage);
  meter.bytes += data.byteLength;
  return handle;
}

/** Whole numbers for each instance. @param each instances that share one */
export function per_instance(gl: Gl, location: number, data: WebGLBuffer | null, numbers: number, type: number, each = 1): void {
  gl.bindBuffer(gl.ARRAY_BUFFER, data);
  gl.enableVertexAttribArray(location);
  gl.vertexAttribIPointer(location, numbers, type, 0, 0);
  gl.vertexAttribDivisor(location, each);
}
