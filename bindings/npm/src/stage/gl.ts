// WebGL2 helpers of the scenes: context, programs, quads, and an HDR target.

/** A program; each uniform's location is looked up once. */
export class Program {
  private readonly program: WebGLProgram;
  private readonly shaders: readonly WebGLShader[];
  private readonly locations = new Map<string, WebGLUniformLocation | null>();
  private checked = false;

  /** Starts compiling. The result is queried at first use, so that compilation runs in parallel. */
  constructor(private readonly gl: WebGL2RenderingContext, vertex: string, fragment: string) {
    this.program = gl.createProgram() as WebGLProgram;
    this.shaders = [begun(gl, gl.VERTEX_SHADER, vertex), begun(gl, gl.FRAGMENT_SHADER, fragment)];
    for (const shader of this.shaders) gl.attachShader(this.program, shader);
    gl.linkProgram(this.program);
  }

  /** Whether compilation is complete and its result was read. Blocks if the browser cannot report completion. */
  warm(): boolean {
    const told = this.gl.getExtension('KHR_parallel_shader_compile');
    if (told === null || this.gl.getProgramParameter(this.program, told.COMPLETION_STATUS_KHR) !== false) this.use();
    return this.checked;
  }

  /** Throws an Error with the compiler's log if the sources are wrong; a lost context is ignored. */
  use(): this {
    if (!this.checked) this.check();
    this.gl.useProgram(this.program);
    return this;
  }

  /** Sets a uniform of 1 to 4 numbers; uniforms that the compiler removed are ignored. */
  set(name: string, ...values: number[]): this {
    this.gl[`uniform${values.length as 1 | 2 | 3 | 4}fv`](this.at(name), values);
    return this;
  }

  setInteger(name: string, value: number): this {
    this.gl.uniform1i(this.at(name), value);
    return this;
  }

  /** Sets an array of vectors of `size` numbers each. */
  setVectors(name: string, size: 1 | 3 | 4, values: Float32Array): this {
    this.gl[`uniform${size}fv`](this.at(name), values);
    return this;
  }

  setMatrix(name: string, values: Float32Array): this {
    this.gl.uniformMatrix4fv(this.at(name), false, values);
    return this;
  }

  dispose(): void {
    this.gl.deleteProgram(this.program);
  }

  private check(): void {
    const { gl, program, shaders } = this;
    this.checked = true;
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const words = [...shaders.map((shader) => gl.getShaderInfoLog(shader)), gl.getProgramInfoLog(program)];
      throw new Error(`a shader is wrong: ${words.filter(Boolean).join(' ')}`);
    }
    for (const shader of shaders) gl.deleteShader(shader);
  }

  private at(name: string): WebGLUniformLocation | null {
    let found = this.locations.get(name);
    if (found === undefined) {
      found = this.gl.getUniformLocation(this.program, name);
      this.locations.set(name, found);
    }
    return found;
  }
}

function begun(gl: WebGL2RenderingContext, kind: number, source: string): WebGLShader {
  const shader = gl.createShader(kind) as WebGLShader;
  gl.shaderSource(shader, `#version 300 es\nprecision highp float;\nprecision highp int;\n${source}`);
  gl.compileShader(shader);
  return shader;
}

/** Returns a function that checks one program per call, as all would delay a frame; true once all are usable. */
export const warming = (programs: Program[]) => (): boolean => {
  const [next] = programs;
  if (next?.warm() === true) programs.shift();
  return next === undefined;
};

export interface Vertices { array: WebGLVertexArrayObject; buffer: WebGLBuffer }

/** Uploads interleaved numbers as attributes 0, 1, … of these sizes. The vertex array stays bound. */
export function verticesOf(gl: WebGL2RenderingContext, numbers: Float32Array, sizes: readonly number[], usage: number = gl.STATIC_DRAW): Vertices {
  const array = gl.createVertexArray() as WebGLVertexArrayObject;
  const buffer = gl.createBuffer() as WebGLBuffer;
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, numbers, usage);
  const stride = sizes.reduce((sum, size) => sum + 4 * size, 0);
  let offset = 0;
  for (const [k, size] of sizes.entries()) {
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, size, gl.FLOAT, false, stride, offset);
    offset += 4 * size;
  }
  return { array, buffer };
}

/** A strip of two triangles: a square from (−1, −1) to (1, 1). */
export const SQUARE = new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]);

/** Draws SQUARE, with its corners as attribute 0. */
export class Quad {
  private readonly vertices: Vertices;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.vertices = verticesOf(gl, SQUARE, [2]);
    gl.bindVertexArray(null);
  }

  draw(): void {
    this.gl.bindVertexArray(this.vertices.array);
    this.gl.drawArrays(this.gl.TRIANGLE_STRIP, 0, 4);
    this.gl.bindVertexArray(null);
  }

  dispose(): void {
    this.gl.deleteVertexArray(this.vertices.array);
    this.gl.deleteBuffer(this.vertices.buffer);
  }
}

/** A picture that is drawn to, then read as a texture. */
export class Target {
  readonly texture: WebGLTexture;
  private readonly frame: WebGLFramebuffer;
  /** multisampled buffers of colour and depth, before resolving */
  private sampled: Record<'frame' | 'colour' | 'depth', WebGLFramebuffer | WebGLRenderbuffer> | null = null;
  width = 0;
  height = 0;

  /** `range`: HDR, where the machine supports it; `samples`: number per pixel, with a depth buffer. */
  constructor(private readonly gl: WebGL2RenderingContext, private readonly options: { range: boolean; samples?: number }) {
    this.texture = gl.createTexture() as WebGLTexture;
    this.frame = gl.createFramebuffer() as WebGLFramebuffer;
  }

  resize(width: number, height: number): void {
    if (this.width === width && this.height === height) return;
    const { gl } = this;
    [this.width, this.height] = [width, height];
    const [inside, kind] = this.options.range && hasRange(gl) ? [gl.RGBA16F, gl.HALF_FLOAT] : [gl.RGBA8, gl.UNSIGNED_BYTE];
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, inside, width, height, 0, gl.RGBA, kind, null);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, axis, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.texture, 0);
    if (this.options.samples !== undefined) this.resizeSamples(this.options.samples);
  }

  /** Directs drawing to this target. */
  begin(): void {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.sampled?.frame ?? this.frame);
    this.gl.viewport(0, 0, this.width, this.height);
  }

  /** Resolves the samples of each pixel; call before reading the texture. */
  finish(): void {
    if (this.sampled === null) return;
    const { gl, width, height } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.sampled.frame);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.frame);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }

  bindTexture(unit: number): void {
    this.gl.activeTexture(this.gl.TEXTURE0 + unit);
    this.gl.bindTexture(this.gl.TEXTURE_2D, this.texture);
  }

  dispose(): void {
    this.gl.deleteFramebuffer(this.frame);
    this.gl.deleteTexture(this.texture);
    this.gl.deleteFramebuffer(this.sampled?.frame ?? null);
    for (const buffer of ['colour', 'depth'] as const) this.gl.deleteRenderbuffer(this.sampled?.[buffer] ?? null);
  }

  private resizeSamples(samples: number): void {
    const { gl } = this;
    this.sampled ??= { frame: gl.createFramebuffer(), colour: gl.createRenderbuffer(), depth: gl.createRenderbuffer() };
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sampled.frame);
    for (const [buffer, format, place] of [['colour', gl.RGBA8, gl.COLOR_ATTACHMENT0], ['depth', gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]] as const) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, this.sampled[buffer]);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, this.width, this.height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, this.sampled[buffer]);
    }
  }
}

/** Whether drawing to HDR targets is supported. */
export function hasRange(gl: WebGL2RenderingContext): boolean {
  return (gl.getExtension('EXT_color_buffer_float') ?? gl.getExtension('EXT_color_buffer_half_float')) !== null;
}

export function drawToCanvas(gl: WebGL2RenderingContext): void {
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
}
