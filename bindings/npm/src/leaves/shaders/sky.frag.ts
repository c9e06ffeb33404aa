export default /* glsl */ `
// Air and ground: autumn light from behind on the left, with mist in the distance.
uniform vec2 uSize;
uniform vec2 uHalf;    // half extents of the view at one metre's distance
uniform vec2 uDown;    // sine and cosine of the eye's pitch (downwards)
uniform vec3 uEye;
uniform float uClock;
out vec4 colour;


vec3 air(vec2 at) {
  vec3 low = vec3(0.96, 0.81, 0.57);
  vec3 high = vec3(0.47, 0.53, 0.53);
  vec3 mist = mix(low, high, smoothstep(-0.15, 1.25, at.y));
  vec2 sun = at - vec2(-0.78, 0.98);
  float far = length(sun);
  mist += vec3(1.0, 0.80, 0.45) * (0.62 * exp(-far * 2.3) + 0.5 * exp(-far * 7.0));
  float turn = atan(sun.y, sun.x);
  float shafts = fractal(vec2(turn * 5.5 + 0.03 * uClock, 0.05 * uClock)) * fractal(vec2(turn * 13.0 - 0.05 * uClock, 3.0));
  mist += vec3(1.0, 0.82, 0.50) * 0.85 * shafts * exp(-far * 0.75) * smoothstep(0.0, 0.5, far);
  // Distant trees, out of focus.
  float slant = at.x + 0.02 * sin(3.0 * at.y) + 0.03 * at.y;
  float trunks = smoothstep(0.50, 0.82, noise(vec2(slant * 8.0, 0.3))) + 0.8 * smoothstep(0.52, 0.86, noise(vec2(slant * 5.0 + 19.0, 5.3)));
  mist *= 1.0 - vec3(0.15, 0.15, 0.12) * trunks * smoothstep(-0.1, 0.3, at.y);
  float canopy = fractal(at * vec2(1.9, 2.4) + 4.0);
  mist *= 1.0 - 0.30 * smoothstep(0.36, 0.62, canopy) * smoothstep(0.05, 1.0, at.y);
  return mist;
}

vec3 ground(vec3 at) {
  float patches = fractal(at.xy * 0.9);
  float grit = fractal(at.xy * 34.0);
  vec3 soil = mix(vec3(0.24, 0.23, 0.12), vec3(0.50, 0.40, 0.25), smoothstep(0.25, 0.75, patches + 0.2 * grit));
  float litter = fractal(at.xy * 11.0 + 3.0);
  soil = mix(soil, vec3(0.50, 0.30, 0.13), 0.55 * smoothstep(0.50, 0.66, litter));
  soil *= 0.84 + 0.30 * grit;
  // Patches of sunlight between the shadows of trees.
  vec2 slant = vec2(at.x - 0.55 * at.y, at.y * 0.5);
  float sun = smoothstep(0.34, 0.60, fractal(slant * 0.8 + vec2(0.012 * uClock, 7.0)));
  return soil * mix(vec3(0.66, 0.66, 0.72), vec3(1.28, 1.12, 0.84), sun);
}

void main() {
  vec2 at = 2.0 * gl_FragCoord.xy / uSize - 1.0;
  vec3 way = vec3(at.x * uHalf.x, uDown.y + at.y * uHalf.y * uDown.x, -uDown.x + at.y * uHalf.y * uDown.y);
  vec2 seen = vec2(at.x * min(1.0, uSize.x / uSize.y), at.y);
  vec3 lit = air(seen);
  if (way.z < 0.0) {
    vec3 place = uEye - way * (uEye.z / way.z);
    float far = length(place - uEye);
    vec3 mist = air(vec2(seen.x, max(seen.y, 0.02)));
    lit = mix(ground(place), mist, 1.0 - exp(-pow(far / 6.8, 2.0)));
  }
  colour = vec4(lit, 1);
}
`;
