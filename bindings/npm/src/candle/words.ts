// Text as a texture for shaders: white on transparent, in lines of about equal width.

/** Height of a line, pixels. */
const LINE = 128;

/** Breaks text between words into lines of about equal length, near `about` characters. */
function brokenLines(text: string, about: number): string[] {
  const lines: string[] = [''];
  const most = text.length / Math.ceil(text.length / about) + 3;
  for (const word of text.trim().split(/\s+/)) {
    const last = lines[lines.length - 1] as string;
    if (last !== '' && last.length + 1 + word.length > most) lines.push(word);
    else lines[lines.length - 1] = last === '' ? word : `${last} ${word}`;
  }
  return lines;
}

export class Words {
  private readonly texture: WebGLTexture;
  private written: string | null = null;
  private shape = 1;
  lines = 1;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.texture = gl.createTexture() as WebGLTexture;
  }

  /** Draws the text if it changed, and binds the texture to a unit. Returns width / height. */
  write(text: string, font: string, about: number, unit: number): number {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    // An empty text keeps the last texture.
    if (text === this.written || (text === '' && this.written !== null)) return this.shape;
    this.written = text;
    const lines = brokenLines(text, about);
    this.lines = lines.length;
    const canvas = new OffscreenCanvas(1, 1);
    const context = canvas.getContext('2d') as OffscreenCanvasRenderingContext2D;
    context.font = font;
    canvas.width = Math.min(2048, Math.ceil(Math.max(LINE, ...lines.map((line) => context.measureText(line).width)) + LINE / 2));
    canvas.height = LINE * lines.length;
    Object.assign(context, { font, fillStyle: '#fff', textAlign: 'center', textBaseline: 'middle' });
    lines.forEach((line, k) => context.fillText(line, canvas.width / 2, (k + 0.5) * LINE, canvas.width - LINE / 4));
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, canvas);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, axis, gl.CLAMP_TO_EDGE);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    return (this.shape = canvas.width / canvas.height);
  }

  dispose(): void {
    this.gl.deleteTexture(this.texture);
  }
}
