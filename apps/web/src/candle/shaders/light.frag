// The room in the light of the flames: wall, table and cake, and the light that hangs in the air around each flame.
uniform sampler2D uSurface;
uniform vec4 uLights[14];   // middle of each flame in the room, and its light
uniform vec4 uHalos[14];    // pixel of the base and of the tip of each flame
uniform float uSpread[14];  // pixels of one model unit of each flame
uniform vec4 uStands[14];   // each candle: foot x, z; radius; height over what it stands on
uniform float uGround;      // height that candles stand on
uniform int uCount;
out vec4 colour;

const vec3 kFire = vec3(1.0, 0.46, 0.13);
const vec3 kMoon = vec3(0.34, 0.52, 1.0);

// Moonlight through a window that is not in the picture: four panes on the wall.
float window(vec2 at) {
  vec2 q = vec2(at.x + 3.55 + 0.22 * at.y, at.y - 3.9);
  vec2 pane = abs(fract(q / vec2(1.05, 1.4)) - 0.5) * 2.0;
  float frame = smoothstep(0.98, 0.70, pane.x) * smoothstep(0.98, 0.76, pane.y);
  vec2 far = abs(q) / vec2(1.05, 1.4);
  return frame * smoothstep(1.05, 0.9, far.x) * smoothstep(1.05, 0.93, far.y);
}

// A candle hides its own flame from what lies around its foot.
float shade(vec3 at, vec4 stand, float lamp) {
  if (at.y > uGround + 0.02) return 1.0;
  float reach = stand.z * (lamp - uGround) / max(0.15, lamp - uGround - stand.w);
  float far = length(at.xz - stand.xy);
  float dark = mix(0.16, 1.0, smoothstep(0.35 * reach, 1.35 * reach, far));
  float contact = smoothstep(stand.z * 0.8, stand.z * 1.7, far);
  return dark * (0.35 + 0.65 * contact);
}

float segment(vec2 p, vec2 a, vec2 b) {
  vec2 ab = b - a;
  return length(p - a - ab * clamp(dot(p - a, ab) / max(1.0, dot(ab, ab)), 0.0, 1.0));
}

void main() {
  Hit hit = hitOf(gl_FragCoord.xy);
  vec4 surface = texelFetch(uSurface, ivec2(gl_FragCoord.xy), 0);
  vec3 albedo = surface.rgb * surface.rgb;
  vec3 eye = normalize(vec3(0.0, uEye, uView.w) - hit.at);
  vec3 light = vec3(0);
  vec3 gloss = vec3(0);
  vec3 air = vec3(0);
  for (int k = 0; k < uCount; ++k) {
    vec3 to = uLights[k].xyz - hit.at;
    float r2 = dot(to, to);
    vec3 way = to * inversesqrt(r2);
    float facing = hit.normal.y > 0.5 ? max(0.0, way.y) : max(0.0, 0.15 + 0.85 * dot(way, hit.normal));
    // What the cream throws back lights the side of the cake.
    if (hit.kind == kOnCakeSide) facing = 0.30 + 0.20 * dot(way, hit.normal) - 0.16 * (uCake.y - hit.at.y);
    float fall = uLights[k].w / (0.25 + r2);
    float seen = shade(hit.at, uStands[k], uLights[k].y);
    if (hit.kind == kOnWall) fall *= 2.6;
    light += kFire * (facing * fall * seen);
    if (surface.a > 0.0 && hit.kind != kOnWall) {
      float shine = max(0.0, dot(hit.normal, normalize(way + eye)));
      gloss += kFire * (surface.a * fall * seen * pow(shine, 70.0));
    }
    float far = segment(gl_FragCoord.xy, uHalos[k].xy, uHalos[k].zw) / uSpread[k];
    float glow = 0.34 * exp(-far * 9.0) + 0.105 * exp(-far * 3.2) + 0.026 * exp(-far * 1.05);
    air += uLights[k].w * mix(vec3(1.0, 0.34, 0.075), vec3(1.0, 0.48, 0.14), exp(-far * 5.0)) * glow;
    // Wax lets some light through to what the candle stands on.
    if (hit.normal.y > 0.5) {
      float foot = max(0.0, length(hit.at.xz - uStands[k].xy) - uStands[k].z);
      light += vec3(1.0, 0.34, 0.08) * uLights[k].w * 0.055 * exp(-foot * 2.6) / (0.4 + uStands[k].w);
    }
  }
  float depth = hit.kind == kOnWall ? 1.0 : smoothstep(3.0, -4.5, hit.at.z);
  vec3 night = vec3(0.011, 0.015, 0.028) * (0.55 + 0.45 * hit.normal.y);
  if (hit.kind == kOnWall) night += 0.085 * kMoon * window(hit.at.xy) + kMoon * 0.010 * smoothstep(9.0, 0.0, length(hit.at.xy - vec2(-4.4, 3.9)));
  else night += kMoon * 0.020 * smoothstep(7.0, 0.0, length(hit.at.xz - vec2(-3.0, -3.0)));
  float corner = hit.kind == kOnWall ? 0.35 + 0.65 * smoothstep(0.0, 1.6, hit.at.y) : 0.55 + 0.45 * smoothstep(-4.6, -2.6, hit.at.z);
  colour = vec4(albedo * (4.4 * light * mix(1.0, 0.8, depth) + 3.0 * night) * corner + 0.9 * gloss + air, 1);
}
