// What the room is made of: colour, and how glossy. Drawn once for every size of the picture.
out vec4 surface;

vec4 wood(vec3 at) {
  vec2 p = at.xz;
  float board = floor(p.y / 1.55 + 0.35);
  vec2 q = vec2(p.x * 0.55 + board * 13.7, p.y * 5.0);
  float bend = fractal(q * vec2(0.5, 0.25) + board) * 2.6;
  float ring = 0.5 + 0.5 * sin((q.y + bend * 2.4) * 2.1 + board * 4.0);
  float grain = fractal(vec2(p.x * 2.5, p.y * 44.0) + board * 7.0);
  vec3 colour = mix(vec3(0.115, 0.056, 0.028), vec3(0.235, 0.122, 0.060), 0.55 * ring + 0.45 * grain);
  colour *= 0.86 + 0.28 * hash1(vec2(board, 3.0));
  float gap = abs(fract(p.y / 1.55 + 0.35) - 0.5) * 2.0;
  colour *= 1.0 - 0.72 * smoothstep(0.982, 0.997, gap);
  return vec4(colour, 0.35 + 0.3 * grain);
}

vec4 plaster(vec3 at) {
  float mottle = fractal(at.xy * 0.7) + 0.4 * fractal(at.xy * 3.1 + 9.0);
  float pores = fractal(at.xy * 17.0);
  return vec4(vec3(0.190, 0.150, 0.128) * (0.72 + 0.42 * mottle + 0.12 * pores), 0.0);
}

vec4 cakeTop(vec3 at) {
  float r = length(at.xz);
  float swirl = 0.5 + 0.5 * sin(r * 26.0 + 2.2 * sin(atan(at.z, at.x) * 3.0));
  vec3 colour = vec3(0.86, 0.78, 0.70) * (0.93 + 0.07 * swirl);
  // A ring of piped rosettes.
  float cells = 34.0;
  float along = (fract(atan(at.z, at.x) / 6.2832 * cells) - 0.5) * 6.2832 * (uCake.x - 0.15) / cells;
  vec2 rose = vec2(along, r - (uCake.x - 0.155)) / 0.158;
  float high = 1.0 - dot(rose, rose);
  float piped = smoothstep(0.0, 0.12, high);
  float curl = 0.82 + 0.18 * sin(9.0 * length(rose) + 2.0 * atan(rose.y, rose.x));
  colour *= 1.0 - 0.35 * smoothstep(-0.5, 0.0, high) * (1.0 - piped);
  colour = mix(colour, vec3(0.90, 0.44, 0.46) * curl * (0.62 + 0.42 * sqrt(max(0.0, high))), piped);
  vec2 cell = floor(at.xz * 7.5);
  vec2 in_cell = fract(at.xz * 7.5) - 0.5;
  float turn = hash1(cell + 5.0) * 6.28;
  vec2 q = mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * (in_cell - 0.3 * (vec2(hash1(cell), hash1(cell + 9.0)) - 0.5));
  float sprinkle = (1.0 - smoothstep(0.055, 0.085, length(vec2(max(abs(q.x) - 0.16, 0.0), q.y)))) * step(0.62, hash1(cell + 2.0));
  vec3 hue = 0.55 + 0.4 * cos(6.28 * (hash1(cell + 1.0) + vec3(0.0, 0.33, 0.67)));
  return vec4(mix(colour, hue, sprinkle * (1.0 - piped)), 0.25);
}

vec4 cakeSide(vec3 at) {
  float turn = atan(at.z, at.x);
  float run = turn * 13.0 + 0.9 * sin(turn * 5.0);
  float drop = 0.17 + (0.10 + 0.26 * hash1(vec2(floor(run / 6.2832 + 0.25), 4.0))) * pow(0.5 + 0.5 * sin(run), 1.6);
  float below = uCake.y - at.y;
  float icing = 1.0 - smoothstep(drop - 0.012, drop + 0.012, below);
  float crumb = fractal(vec2(turn * 16.0, at.y * 18.0));
  vec3 sponge = mix(vec3(0.17, 0.075, 0.036), vec3(0.30, 0.150, 0.078), crumb);
  float layer = smoothstep(0.045, 0.03, abs(at.y - 0.46 * uCake.y));
  sponge = mix(sponge, vec3(0.80, 0.70, 0.58), layer);
  vec3 cream = vec3(0.86, 0.77, 0.69) * (0.80 + 0.20 * smoothstep(0.0, 0.07, drop - below));
  float foot = smoothstep(0.20, 0.16, at.y) * (0.6 + 0.4 * abs(sin(turn * 19.0)));
  return vec4(mix(mix(sponge, cream, icing), vec3(0.80, 0.44, 0.44), foot), 0.1 * icing);
}

vec4 plate(vec3 at) {
  float r = length(at.xz) - uCake.x;
  float line = smoothstep(0.03, 0.0, abs(r - 0.28));
  return vec4(mix(vec3(0.34, 0.34, 0.38), vec3(0.42, 0.28, 0.10), line), 0.6);
}

void main() {
  Hit hit = hitOf(gl_FragCoord.xy);
  if (hit.kind > 1.5) hit.at.x -= uCake.z;
  if (hit.kind == kOnWall) surface = plaster(hit.at);
  else if (hit.kind == kOnTable) surface = wood(hit.at);
  else if (hit.kind == kOnPlate) surface = plate(hit.at);
  else if (hit.kind == kOnCakeTop) surface = cakeTop(hit.at);
  else surface = cakeSide(hit.at);
  // Finer than eight bits in the dark.
  surface.rgb = sqrt(surface.rgb);
}
