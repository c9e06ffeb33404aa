export default /* glsl */ `
// A candle: translucent wax, melted pool, wick with ember, and the saucer below. Origin: centre of the upper end; flame
// units.
uniform float uRadius, uHeight, uPixel, uLight, uEmber, uSeed, uStripe, uSaucer, uClock, uTurn;
uniform vec2 uFlat;      // height / width of the upper and lower end's ellipses
uniform vec2 uLean;      // position of the flame's middle
uniform vec3 uWax;
uniform vec4 uOthers;    // light of other flames: from left, right and behind, and overall
in vec2 vAt;
out vec4 colour;

const vec3 kFire = vec3(1.0, 0.46, 0.13);
const vec3 kMoon = vec3(0.30, 0.47, 0.92);

// Height of old drips on the side: up to twelve around the candle, each ending in a bead.
float drips(float turn, float below) {
  float sum = 0.0;
  float cell = floor((turn + uTurn) / 0.5236);
  for (float k = -1.0; k <= 1.0; ++k) {
    float which = mod(cell + k, 12.0);
    float chance = hash1(vec2(uSeed + 3.0, which));
    float at = (cell + k + 0.5) * 0.5236 + 0.36 * (hash1(vec2(uSeed, which)) - 0.5) + 0.03 * sin(7.0 * below + 9.0 * chance);
    float lasts = uHeight * (0.08 + 0.46 * chance * chance);
    float bead = exp(-pow((below - lasts + 0.05) / 0.07, 2.0));
    float wide = 0.07 + 0.09 * exp(-below / 0.16) + 0.035 * bead;
    float there = smoothstep(lasts + 0.03, lasts - 0.03, below);
    float across = (turn + uTurn - at) / wide;
    sum += there * (0.55 + 0.45 * bead) * exp(-across * across);
  }
  return min(1.0, sum) * (1.0 - uStripe);
}

vec3 side(float u, float below) {
  float turn = asin(clamp(u, -1.0, 1.0));
  float s = sqrt(max(0.0, 1.0 - u * u));
  float lift = drips(turn, below);
  float slope = (drips(turn + 0.025, below) - lift) / 0.025;
  float drop = (drips(turn, below + 0.02) - lift) / 0.02;
  vec3 normal = normalize(vec3(u - 0.10 * slope * s, 0.09 * drop, s + 0.10 * slope * u));
  float deep = below / max(0.35, uRadius / 0.33);
  // Light transmitted down from the pool: soon red, then absorbed.
  float through = 1.35 * exp(-deep / 0.26) + 0.50 * exp(-deep / 0.85) + 0.05 * exp(-deep / 3.0);
  through *= 0.70 + 0.30 * u * u + 0.22 * lift;
  through *= 1.0 + 0.9 * uLean.x * u * exp(-deep / 0.5);
  through *= 0.93 + 0.14 * fractal(vec2(turn * 3.0 + uSeed, below * 2.2));
  vec3 hue = mix(vec3(1.0, 0.56, 0.21), vec3(0.80, 0.17, 0.030), 1.0 - exp(-deep / 0.62));
  vec3 wax = uWax;
  float band = fract((below / uRadius) * 0.42 + (turn + uTurn) * 0.3183);
  float edge = fwidth((below / uRadius) * 0.42) * 2.0;
  wax = mix(wax, vec3(0.90, 0.87, 0.83), uStripe * smoothstep(0.5 - edge, 0.5 + edge, abs(band - 0.5) * 2.0));
  vec3 lit = wax * hue * through * uLight;
  float lamps = uOthers.x * max(0.0, -normal.x) + uOthers.y * max(0.0, normal.x) + uOthers.z * (1.0 - s) * 0.7 + 0.25 * uOthers.w;
  lit += wax * kFire * lamps;
  // Light of the flame, grazing the drips from above; warm room light; moonlight from the right, behind.
  lit += wax * kFire * uLight * (0.16 * max(0.0, normal.y) * exp(-deep / 0.6) + 0.022 * (0.6 + 0.4 * s));
  float moon = max(0.0, 0.25 + 0.75 * dot(normal, vec3(0.88, 0.24, 0.10)));
  lit += wax * kMoon * (0.002 + 0.026 * pow(moon, 1.6));
  float shine = pow(max(0.0, dot(normal, normalize(vec3(uLean.x - 0.2 * u, 0.55, 1.0)))), 40.0);
  lit += kFire * uLight * 0.20 * shine * lift * exp(-deep / 0.7) + kMoon * 0.03 * lift * pow(moon, 8.0);
  return lit;
}

// Upper end: a rim of wax, and the pool that mirrors the flame.
vec3 top(vec2 q) {
  float r = length(q);
  float edge = 0.80 + 0.06 * (noise(q * 2.6 + uSeed) - 0.5);
  float wet = smoothstep(edge + 0.02, edge - 0.05, r);
  float near = exp(-r * r * 1.7);
  vec3 solid = uWax * vec3(1.0, 0.62, 0.27) * (0.95 + 0.75 * smoothstep(edge, 0.97, r)) * (0.75 + 0.6 * near);
  vec3 melted = uWax * vec3(0.95, 0.44, 0.13) * (0.38 + 1.15 * near);
  vec3 lit = mix(solid, melted, wet) * (uLight + 0.30 * uOthers.w) + uWax * kMoon * 0.008;
  // Meniscus at the pool's edge, brightest opposite the flame.
  lit += kFire * uLight * 0.55 * exp(-pow((r - edge + 0.02) / 0.030, 2.0)) * (0.6 - 0.4 * q.y + 0.9 * uLean.x * q.x);
  vec2 ripple = 0.02 * vec2(sin(9.0 * q.y + 5.0 * uClock), sin(7.0 * q.x - 4.0 * uClock)) * uLight;
  vec2 mirror = (q + ripple - vec2(1.6 * uLean.x, -0.36)) / vec2(0.10, 0.27);
  lit += vec3(1.0, 0.80, 0.50) * wet * uLight * 3.2 * exp(-dot(mirror, mirror));
  vec2 rim = (q - vec2(0.50, 0.46)) / vec2(0.20, 0.07);
  lit += kMoon * 0.09 * wet * exp(-dot(rim, rim));
  return lit;
}

// Distance from the wick's line, and position along it (0 to 1).
vec2 wick(vec2 p) {
  vec2 a = vec2(0.0, -0.012), b = vec2(-0.016 * cos(uTurn), 0.10), c = vec2((0.030 + 0.02 * hash1(vec2(uSeed, 8.0))) * cos(uTurn), 0.165);
  float best = 1e9, along = 0.0;
  vec2 from = a;
  for (int k = 1; k <= 8; ++k) {
    float t = float(k) / 8.0;
    vec2 to = mix(mix(a, b, t), mix(b, c, t), t);
    vec2 way = to - from;
    float part = clamp(dot(p - from, way) / dot(way, way), 0.0, 1.0);
    float far = length(p - from - way * part);
    if (far < best) { best = far; along = t - (1.0 - part) / 8.0; }
    from = to;
  }
  return vec2(best - 0.0125 + 0.003 * noise(p * 90.0 + uSeed), along);
}

// A shallow brass dish under a lone candle; alpha is the coverage of the pixel.
vec4 saucer() {
  float flat_ = uFlat.y;
  vec2 p = vec2(vAt.x, vAt.y + uHeight);
  vec2 brim = vec2(p.x, (p.y - 0.055) / flat_) / uSaucer;
  vec2 base = vec2(p.x, p.y / flat_) / (0.80 * uSaucer);
  float soft = 1.6 * uPixel / (uSaucer * flat_);
  float r = length(brim);
  float inside = smoothstep(1.0 + soft, 1.0 - soft, r);
  float outer = max(inside, smoothstep(1.0 + soft, 1.0 - soft, length(base)));
  // The wall between brim and base bulges and is visible in front.
  outer = max(outer, smoothstep(soft, -soft, length(vec2(p.x, (p.y - 0.028) / flat_) / uSaucer) - 0.955));
  float foot = max(0.0, length(vec2(p.x, p.y / flat_)) - uRadius);
  vec3 brass = vec3(0.36, 0.215, 0.075) * (0.85 + 0.3 * fractal(vec2(atan(brim.y, brim.x) * 2.0, r * 34.0)));
  float lip = exp(-pow((r - 0.985) / (0.018 + soft), 2.0));
  float well = smoothstep(0.70, 0.78, r) * smoothstep(0.97, 0.88, r);
  vec3 lit = brass * vec3(1.0, 0.36, 0.10) * uLight * 0.34 * exp(-foot * 2.6) * inside;
  lit += brass * kFire * uLight * (0.05 + 0.16 * well * (0.5 + 0.5 * brim.y) + 0.07 * pow(abs(brim.x), 2.0));
  float glint = 0.25 + 0.75 * pow(abs(brim.x), 3.0);
  lit += brass * kFire * uLight * lip * (0.16 + 0.9 * glint * smoothstep(-0.6, 0.5, brim.y));
  lit += kFire * uLight * 0.30 * (1.0 - inside) * exp(-pow(brim.x / 0.22, 2.0)) * 0.25;
  lit *= 1.0 - 0.75 * exp(-foot * 22.0);
  lit += kMoon * (0.002 + 0.030 * lip * smoothstep(-0.2, 0.9, brim.x + 0.5 * brim.y)) * (0.4 + 0.6 * inside);
  return vec4(lit, outer);
}

void main() {
  float belowRim = max(0.0, -vAt.y);
  float swell = 1.0 + (1.0 - uStripe) * 0.035 * drips(vAt.x > 0.0 ? 1.35 : -1.35, belowRim) + (1.0 - uStripe) * 0.02 * (noise(vec2(sign(vAt.x) * 4.0, vAt.y * 2.0 + uSeed)) - 0.5);
  float u = vAt.x / (uRadius * swell);
  float s = sqrt(max(0.0, 1.0 - u * u));
  float turn = asin(clamp(u, -1.0, 1.0));
  float wobble = (1.0 - uStripe) * (0.030 * (noise(vec2(turn * 2.2 + uSeed, 1.0)) - 0.5) + 0.012 * (noise(vec2(turn * 7.0, uSeed)) - 0.5));
  float front = -uFlat.x * uRadius * s + wobble;
  float back = uFlat.x * uRadius * s + 0.6 * wobble;
  float foot = -uHeight - uFlat.y * uRadius * s;
  float across = smoothstep(1.0, 1.0 - 1.5 * uPixel / uRadius, abs(u));
  float body = across * smoothstep(back + uPixel, back - uPixel, vAt.y) * smoothstep(foot - uPixel, foot + uPixel, vAt.y);
  vec3 wall = side(u, max(0.0, front - vAt.y));
  vec3 lid = top(vec2(u, (vAt.y - wobble) / (uFlat.x * uRadius)));
  vec3 lit = mix(wall, lid, smoothstep(front - uPixel, front + uPixel, vAt.y));
  // The thin, bright lip between wall and lid.
  float lip = exp(-pow((vAt.y - front) / (0.010 + uPixel), 2.0)) * (0.6 + 0.4 * noise(vec2(turn * 6.0, uSeed)));
  lit += lip * uWax * vec3(1.0, 0.60, 0.27) * 0.50 * uLight;
  // The candle is darker at its foot.
  lit *= 1.0 - 0.6 * exp(-(vAt.y - foot) / 0.05) * (1.0 - uStripe);
  vec2 thread = wick(vAt);
  float here = smoothstep(uPixel, -uPixel, thread.x);
  vec3 char = vec3(0.010, 0.008, 0.007) + vec3(0.22, 0.10, 0.035) * uLight * smoothstep(0.40, 0.0, thread.y);
  float burning = smoothstep(0.62, 0.98, thread.y);
  vec3 ember = vec3(1.6, 0.21, 0.012) * uEmber * burning * (0.30 + 1.1 * noise(vAt * 120.0 + uSeed + 0.7 * uClock));
  // The wick covers the wax, and both cover the saucer.
  vec4 all = vec4(lit, 1) * body;
  all = mix(all, vec4(char + ember, 1), here);
  vec4 below = uSaucer > 0.0 ? saucer() : vec4(0);
  colour = all + vec4(below.rgb, 1) * below.a * (1.0 - all.a);
}
`;
