export default /* glsl */ `
// A candle shaped as a digit: a rounded bar of wax along a line, lit by the flame on top. Flame units.
uniform vec3 uOutline[64];  // points of the line
uniform int uPoints;
uniform float uRadius, uHeight, uLight, uEmber, uPixel;
uniform vec3 uWax;
uniform vec4 uOthers;       // light of other flames: from left, right and behind, and overall
in vec2 vAt;
out vec4 colour;

const vec3 kFire = vec3(1.0, 0.46, 0.13);
const vec3 kMoon = vec3(0.30, 0.47, 0.92);

void main() {
  float far = 1e9;
  vec2 nearest = vec2(0);
  for (int k = 1; k < uPoints; ++k) {
    vec2 from = uOutline[k - 1].xy, way = uOutline[k].xy - from;
    vec2 place = from + way * clamp(dot(vAt - from, way) / max(1e-9, dot(way, way)), 0.0, 1.0);
    float off = length(vAt - place);
    if (off < far) { far = off; nearest = place; }
  }
  float body = smoothstep(uRadius + uPixel, uRadius - uPixel, far);
  float u = min(1.0, far / uRadius);
  float s = sqrt(1.0 - u * u);
  vec3 normal = vec3((vAt - nearest) / uRadius, s);
  float deep = length(vAt) / 0.9;
  float through = 1.25 * exp(-deep / 0.30) + 0.55 * exp(-deep / 0.9) + 0.10 * exp(-deep / 3.0);
  vec3 hue = mix(vec3(1.0, 0.60, 0.26), vec3(0.86, 0.24, 0.06), 1.0 - exp(-deep / 0.7));
  vec3 lit = uWax * hue * through * uLight * (0.55 + 0.45 * s);
  float lamps = uOthers.x * max(0.0, -normal.x) + uOthers.y * max(0.0, normal.x) + 0.30 * uOthers.w;
  vec3 lamp = normalize(vec3(0.0, 0.35, 0.35) - vec3(vAt, 0.0));
  lit += uWax * kFire * (lamps + 0.55 * uLight * max(0.0, dot(normal, lamp)) / (0.4 + dot(vAt, vAt)) + 0.05 * uLight);
  lit += kFire * (0.35 * uLight + 0.3 * uOthers.w) * pow(max(0.0, dot(normal, normalize(lamp + vec3(0, 0, 1)))), 36.0);
  lit += uWax * kMoon * (0.004 + 0.03 * pow(max(0.0, dot(normal, vec3(0.85, 0.35, 0.30))), 2.0));
  vec4 all = vec4(lit, 1) * body;
  float wick = smoothstep(0.016 + uPixel, 0.016 - uPixel, abs(vAt.x - 0.05 * vAt.y)) * step(0.0, vAt.y) * smoothstep(uRadius + 0.12 + uPixel, uRadius + 0.12 - uPixel, vAt.y);
  vec3 char = vec3(0.011, 0.009, 0.008) + vec3(1.6, 0.21, 0.012) * uEmber * smoothstep(0.06, 0.16, vAt.y);
  colour = mix(all, vec4(char, 1), wick);
}
`;
