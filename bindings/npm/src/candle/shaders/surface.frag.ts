export default /* glsl */ `
// Material of the room: colour and gloss. Drawn again only when size, view, cake or name change.
out vec4 surface;

vec4 wood(vec3 at) {
  vec2 p = before(at.xz);
  float row = floor(p.y / 1.55 + 0.35);
  // Ends of boards, offset from row to row.
  float end = (p.x + 17.0 * hash1(vec2(row, 21.0))) / 6.4;
  float board = row + 31.0 * floor(end);
  vec2 q = vec2(p.x * 0.55 + board * 13.7, p.y * 5.0);
  float bend = fractal(q * vec2(0.5, 0.25) + board) * 2.6;
  float ring = 0.5 + 0.5 * sin((q.y + bend * 2.4) * 2.1 + board * 4.0);
  float grain = fractal(vec2(p.x * 2.5, p.y * 44.0) + board * 7.0);
  vec3 colour = mix(vec3(0.115, 0.056, 0.028), vec3(0.235, 0.122, 0.060), 0.55 * ring + 0.45 * grain);
  colour *= 0.86 + 0.28 * hash1(vec2(board, 3.0));
  float gap = abs(fract(p.y / 1.55 + 0.35) - 0.5) * 2.0;
  float cut = min(fract(end), 1.0 - fract(end)) * 6.4;
  // Near a cut the grain absorbs more oil and is darker.
  colour *= (1.0 - 0.72 * max(smoothstep(0.982, 0.997, gap), 0.7 * smoothstep(0.012, 0.004, cut))) * (1.0 - 0.22 * exp(-cut * 9.0));
  return vec4(colour, 0.35 + 0.3 * grain);
}

vec4 plaster(vec3 at) {
  // Rotation of the eye shifts the pattern, as if further walls continued this one.
  at.x += 9.0 * uTurn;
  float mottle = fractal(at.xy * 0.7) + 0.4 * fractal(at.xy * 3.1 + 9.0);
  float pores = fractal(at.xy * 17.0);
  return vec4(vec3(0.190, 0.150, 0.128) * (0.72 + 0.42 * mottle + 0.12 * pores), 0.0);
}

void main() {
  Hit hit = hitOf(gl_FragCoord.xy);
  surface = hit.kind == kOnWall ? plaster(hit.at) : hit.kind == kOnTable ? wood(hit.at) : cakeSurface(hit);
  // Stored as square roots: the steps of eight bits are finer in the dark.
  surface.rgb = sqrt(surface.rgb);
}
`;
