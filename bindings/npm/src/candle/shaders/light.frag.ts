export default /* glsl */ `
// The room lit by flames and moon: wall, table, cake, and light scattered in the air.
uniform sampler2D uSurface;
uniform vec4 uLights[14];   // position of each flame's middle, and its light
uniform vec4 uHalos[14];    // pixels of each flame's base and tip
uniform float uSpread[14];  // pixels per flame unit
uniform vec4 uStands[14];   // each candle: foot x, z; radius; height above its support
uniform float uGround;      // height of the candles' support
uniform float uFoot;        // radius of each candle's dish, in radii of the candle
uniform int uCount;
uniform vec4 uMatch;        // pixels of the lying match's head and end
uniform float uMatchThick;  // half width of its shadow, pixels; 0: no match lies there
out vec4 colour;

const vec3 kFire = vec3(1.0, 0.44, 0.115);
// Colour of light reflected repeatedly in bright icing, which loses little red: nearly white to adapted eyes.
const vec3 kOnCream = vec3(1.0, 0.67, 0.40);
const vec3 kMoon = vec3(0.36, 0.56, 1.0);

// Moonlight on the wall through an unseen window: nine panes, slanted, low enough for wide pictures.
float window(vec2 at) {
  at.y -= 1.96;
  vec2 q = vec2(at.x - 1.95 + 0.30 * at.y, at.y) / vec2(0.50, 0.56);
  vec2 pane = abs(fract(q + 0.5) - 0.5) * 2.0;
  vec2 soft = smoothstep(vec2(0.97), vec2(0.78, 0.84), pane);
  vec2 out_ = smoothstep(vec2(1.55), vec2(1.40), abs(q));
  return mix(0.35, 1.0, soft.x * soft.y) * out_.x * out_.y;
}

// Share of a lamp's light that its own candle lets through around the foot: 1 far away.
float shade(vec3 at, vec4 stand, vec3 lamp) {
  if (at.y > uGround + 0.02) return 1.0;
  float high = max(0.15, lamp.y - uGround - stand.w);
  float share = stand.w / (stand.w + high);
  vec2 past = mix(at.xz, lamp.xz, share) - stand.xy;
  float dark = smoothstep(0.45, 1.55, length(past) / stand.z);
  float contact = smoothstep(0.72, 1.55, length(at.xz - stand.xy) / (stand.z * uFoot));
  return mix(0.10, 1.0, dark) * mix(0.28, 1.0, contact);
}

float segment(vec2 p, vec2 a, vec2 b) {
  vec2 ab = b - a;
  return length(p - a - ab * clamp(dot(p - a, ab) / max(1.0, dot(ab, ab)), 0.0, 1.0));
}

// Light from a place to the eye.
vec3 shown(Hit hit, vec4 surface) {
  vec3 albedo = surface.rgb * surface.rgb;
  vec3 eye = normalize(vec3(0.0, uEye, uView.w) - hit.at);
  bool level = hit.normal.y > 0.5;
  vec3 fire = hit.kind == kOnCakeTop ? kOnCream : mix(kFire, kOnCream, hit.kind >= kOnPlate ? 0.6 : 0.0);
  vec3 light = vec3(0);
  vec3 gloss = vec3(0);
  for (int k = 0; k < uCount; ++k) {
    vec3 to = uLights[k].xyz - hit.at;
    float r2 = dot(to, to);
    vec3 way = to * inversesqrt(r2);
    float facing = level ? max(0.0, dot(way, hit.normal)) : max(0.0, 0.15 + 0.85 * dot(way, hit.normal));
    // The side of the cake is lit by light reflected from the cream.
    if (hit.kind == kOnCakeSide) facing = 0.40 + 0.22 * dot(way, hit.normal) - 0.16 * (uCake.y - hit.at.y);
    float fall = uLights[k].w / (0.22 + r2);
    float seen = shade(hit.at, uStands[k], uLights[k].xyz);
    if (hit.kind == kOnCakeTop) seen *= sticks(hit.at, uLights[k].xyz);
    light += fire * (facing * fall * seen * (hit.kind == kOnWall ? 1.9 : hit.kind == kOnCakeTop ? 0.62 : 1.0));
    if (surface.a > 0.0 && hit.kind != kOnWall) {
      float shine = max(0.0, dot(hit.normal, normalize(way + eye)));
      gloss += fire * (surface.a * fall * seen * (0.9 * pow(shine, 60.0) + 0.10 * pow(shine, 12.0)));
    }
    // Some light passes through the wax to the candle's support.
    if (level) {
      float foot = max(0.0, length(hit.at.xz - uStands[k].xy) - uStands[k].z);
      light += vec3(1.0, 0.30, 0.06) * uLights[k].w * 0.05 * exp(-foot * 2.2) / (0.4 + uStands[k].w);
    }
  }
  // Moonlight is dimmed while flames burn.
  float lit = 0.0;
  for (int k = 0; k < uCount; ++k) lit += uLights[k].w;
  float moon = mix(1.0, 0.12, min(1.0, 2.5 * lit));
  vec3 night = vec3(0.005, 0.007, 0.013) * (0.55 + 0.45 * hit.normal.y);
  if (hit.kind == kOnWall) {
    vec2 wall = hit.at.xy + vec2(9.0 * sin(0.5 * uTurn), 0);
    night += kMoon * moon * (0.040 * window(wall) + 0.008 * exp(-0.35 * length(wall - vec2(1.9, 2.0))));
  }
  // Moonlight from the right colours the right side of the cake.
  else if (hit.kind == kOnCakeSide) night += kMoon * (0.01 + 0.13 * smoothstep(0.30, 1.0, hit.normal.x));
  else night += kMoon * 0.013 * smoothstep(6.5, 0.0, length(hit.at.xz - vec2(1.2, -3.0)));
  float corner = hit.kind == kOnWall ? 0.30 + 0.70 * smoothstep(0.0, 1.9, hit.at.y) : 0.50 + 0.50 * smoothstep(-4.6, -2.4, hit.at.z);
  return albedo * (4.2 * light + 3.0 * night) * corner + 0.7 * gloss;
}

void main() {
  vec2 at = gl_FragCoord.xy;
  ivec2 cell = ivec2(at);
  Hit hit = hitOf(at);
  vec3 light;
#if SAMPLES > 1
  // Where surfaces meet within a pixel, averages four samples.
  Hit a = hitOf(at + vec2(-0.375, -0.125)), b = hitOf(at + vec2(0.125, -0.375)), c = hitOf(at + vec2(0.375, 0.125)), d = hitOf(at + vec2(-0.125, 0.375));
  if (a.kind != c.kind || b.kind != d.kind || a.kind != b.kind) {
    light = 0.25 * (shown(a, texelFetch(uSurface, cell + ivec2(-1, 0), 0)) + shown(b, texelFetch(uSurface, cell + ivec2(0, -1), 0)) +
                    shown(c, texelFetch(uSurface, cell + ivec2(1, 0), 0)) + shown(d, texelFetch(uSurface, cell + ivec2(0, 1), 0)));
  } else
#endif
  light = shown(hit, texelFetch(uSurface, cell, 0));
  if (uMatchThick > 0.0 && hit.kind == kOnTable) {
    float off = segment(at + vec2(-0.5, 0.9) * uMatchThick, uMatch.xy, uMatch.zw) / uMatchThick;
    light *= 1.0 - 0.70 * exp(-off * off);
  }
  vec3 air = vec3(0);
  for (int k = 0; k < uCount; ++k) {
    float far = segment(at, uHalos[k].xy, uHalos[k].zw) / uSpread[k];
    float glow = 0.16 * exp(-far * 8.0) + 0.045 * exp(-far * 2.6) + 0.010 * exp(-far * 0.9);
    air += uLights[k].w * mix(vec3(1.0, 0.32, 0.07), vec3(1.0, 0.46, 0.13), exp(-far * 5.0)) * glow;
  }
  colour = vec4(light + air, 1);
}
`;
