// A candle: wax that its flame shines through, the melted pool, the wick and its ember. The foot is the middle of the
// upper end; units are the flame's.
uniform float uRadius, uHeight, uPixel, uLight, uEmber, uSeed, uStripe;
uniform vec2 uFlat;      // how round the upper and the lower end look: axes of their ellipses
uniform vec2 uLean;      // where the flame's middle is
uniform vec3 uWax;
uniform vec4 uOthers;    // light of the other flames: from the left, from the right, from behind, on the whole
in vec2 vAt;
out vec4 colour;

const vec3 kFire = vec3(1.0, 0.50, 0.16);

// How far wax stands out there: runs of old drops down the side.
float drips(float turn, float below) {
  float sum = 0.0;
  for (int k = 0; k < 5; ++k) {
    float at = -1.25 + 0.62 * float(k) + 0.4 * (hash1(vec2(uSeed, float(k))) - 0.5);
    float lasts = uHeight * (0.12 + 0.42 * hash1(vec2(float(k), uSeed + 3.0)));
    float wide = 0.085 * (1.0 + 0.5 * smoothstep(lasts - 0.22, lasts - 0.05, below));
    float there = smoothstep(lasts + 0.05, lasts - 0.05, below);
    float across = (turn - at) / wide;
    sum += there * exp(-across * across);
  }
  return sum * (1.0 - uStripe);
}

vec3 side(float u, float below) {
  float turn = asin(clamp(u, -1.0, 1.0));
  float s = sqrt(max(0.0, 1.0 - u * u));
  float lift = drips(turn, below);
  float slope = (drips(turn + 0.03, below) - lift) / 0.03;
  vec3 normal = normalize(vec3(u - 0.09 * slope * s, 0.0, s + 0.09 * slope * u));
  float wide = uRadius / 0.33;
  float deep = below / max(0.35, wide);
  float through = 1.35 * exp(-deep / 0.24) + 0.62 * exp(-deep / 1.05) + 0.06;
  through *= 0.74 + 0.34 * u * u + 0.16 * lift;
  through *= 1.0 + 0.5 * uLean.x * u * exp(-deep / 0.5);
  vec3 hue = mix(vec3(1.0, 0.50, 0.16), vec3(0.90, 0.19, 0.035), 1.0 - exp(-deep / 0.8));
  vec3 wax = uWax;
  float band = fract((below / uRadius) * 0.42 + turn * 0.32);
  wax = mix(wax, vec3(0.93, 0.90, 0.86), uStripe * smoothstep(0.47, 0.5, abs(band - 0.5) * 2.0));
  vec3 lit = wax * hue * through * uLight;
  float lamps = uOthers.x * max(0.0, -normal.x) + uOthers.y * max(0.0, normal.x) + uOthers.z * (1.0 - s) * 0.7 + 0.25 * uOthers.w;
  lit += wax * kFire * lamps;
  float moon = max(0.0, dot(normal, normalize(vec3(-0.8, 0.2, 0.45))));
  lit += wax * vec3(0.30, 0.45, 0.9) * (0.006 + 0.034 * pow(moon, 2.4));
  lit += kFire * uLight * 0.10 * lift * exp(-deep * 1.4) * pow(max(0.0, normal.z), 18.0);
  return lit;
}

vec3 top(vec2 q, out float wet) {
  float r = length(q);
  float edge = 0.80 + 0.05 * noise(q * 3.0 + uSeed);
  wet = 1.0 - smoothstep(edge - 0.05, edge + 0.03, r);
  float near = exp(-r * r * 1.7);
  vec3 solid = uWax * vec3(1.0, 0.60, 0.26) * (0.75 + 0.55 * smoothstep(edge, 0.97, r)) * (0.9 + 0.5 * near);
  vec3 melted = uWax * vec3(1.0, 0.52, 0.18) * (0.50 + 1.25 * near);
  vec3 lit = mix(solid, melted, wet) * (uLight * 1.25);
  lit += mix(solid, melted, wet) * (0.35 * uOthers.w) + uWax * vec3(0.30, 0.45, 0.9) * 0.020;
  // The flame in the pool's mirror, and the moon at its far edge.
  vec2 mirror = (q - vec2(1.4 * uLean.x, -0.34)) / vec2(0.11, 0.30);
  lit += vec3(1.0, 0.72, 0.36) * wet * uLight * 1.5 * exp(-dot(mirror, mirror));
  vec2 rim = (q - vec2(-0.52, 0.50)) / vec2(0.16, 0.07);
  lit += vec3(0.30, 0.45, 0.9) * 0.10 * wet * exp(-dot(rim, rim));
  return lit;
}

// Distance from the wick's line, and how far up it is (0 to 1).
vec2 wick(vec2 p) {
  float thin = min(1.0, uRadius / 0.2);
  vec2 a = vec2(0.0, -0.05), b = vec2(-0.012, 0.09), c = vec2(0.030 + 0.02 * hash1(vec2(uSeed, 8.0)), 0.175);
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
  return vec2(best - mix(0.019, 0.015, along) * mix(0.8, 1.0, thin), along);
}

void main() {
  float u = vAt.x / uRadius;
  float s = sqrt(max(0.0, 1.0 - u * u));
  float turn = asin(clamp(u, -1.0, 1.0));
  float wobble = 0.018 * (noise(vec2(turn * 2.2 + uSeed, 1.0)) - 0.5) * (1.0 - uStripe);
  float front = -uFlat.x * uRadius * s + wobble;
  float back = uFlat.x * uRadius * s + wobble;
  float foot = -uHeight - uFlat.y * uRadius * s;
  float across = smoothstep(1.0, 1.0 - 1.5 * uPixel / uRadius, abs(u));
  float body = across * smoothstep(back + uPixel, back - uPixel, vAt.y) * smoothstep(foot - uPixel, foot + uPixel, vAt.y);
  vec3 wall = side(u, max(0.0, front - vAt.y));
  float wet;
  vec3 lid = top(vec2(u, (vAt.y - wobble) / (uFlat.x * uRadius)), wet);
  float onLid = smoothstep(front - uPixel, front + uPixel, vAt.y);
  // The lip between them catches the light.
  float lip = exp(-pow((vAt.y - front) / (0.012 + uPixel), 2.0));
  vec3 lit = mix(wall, lid, onLid) + lip * uWax * vec3(1.0, 0.58, 0.24) * 0.55 * uLight;
  vec2 thread = wick(vAt);
  float here = smoothstep(uPixel, -uPixel, thread.x);
  vec3 char = vec3(0.014, 0.011, 0.010) + vec3(0.20, 0.10, 0.04) * uLight * smoothstep(0.55, 0.0, thread.y) * 0.5;
  float burning = smoothstep(0.52, 0.95, thread.y);
  vec3 ember = vec3(3.4, 0.62, 0.06) * uEmber * burning * (0.55 + 0.9 * noise(vAt * 110.0 + uSeed));
  float bloom = smoothstep(0.15, 0.4, uEmber) * uEmber * exp(-max(0.0, thread.x) * 26.0) * burning;
  lit = mix(lit, char + ember, here);
  float alpha = max(body, here);
  colour = vec4(lit * alpha + vec3(1.0, 0.22, 0.03) * 0.30 * bloom, alpha);
}
