export default /* glsl */ `
// A cake on its plate: where the eye meets it, what it is made of, and the shadows of the candles on it.
#define SAMPLES 4
uniform sampler2D uName;
uniform vec2 uPlaque;      // half of its width and height; 0: there is none
uniform vec4 uSticks[12];  // each candle on the cake: foot x, z; radius; height over the cake

// First k > 0 where the ray meets the standing cylinder of that radius; 0: never.
float cylinder(vec2 way, float radius, float middle) {
  float d2 = uView.w * uView.w;
  float a = way.x * way.x + d2;
  float b = d2 + way.x * middle;
  float root = b * b - a * (d2 + middle * middle - radius * radius);
  return root < 0.0 ? 0.0 : (b - sqrt(root)) / a;
}

Hit hitOf(vec2 pixel) {
  vec2 way = (pixel - uView.xy) / uView.z;
  Hit hit = roomHit(way);
  vec2 middle = vec2(uCake.z, 0);
  vec3 onPlate = onRay(way, (0.06 - uEye) / min(way.y, -1e-4));
  float rim = length(onPlate.xz - middle) - uCake.x;
  if (rim < 0.36) {
    // The plate curves up to its edge.
    vec2 out_ = normalize(onPlate.xz - middle);
    float bend = -0.55 * smoothstep(0.20, 0.36, rim);
    hit = Hit(onPlate, normalize(vec3(out_.x * bend, 1, out_.y * bend)), kOnPlate);
  }
  vec3 onTop = onRay(way, (uCake.y - uEye) / min(way.y, -1e-4));
  if (length(onTop.xz - middle) < uCake.x) return Hit(onTop, vec3(0, 1, 0), kOnCakeTop);
  float side = cylinder(way, uCake.x, uCake.z);
  vec3 onSide = onRay(way, side);
  if (side > 0.0 && onSide.y < uCake.y && onSide.y > 0.06) {
    return Hit(onSide, vec3(onSide.x - uCake.z, 0, onSide.z) / uCake.x, kOnCakeSide);
  }
  return hit;
}

vec4 cakeTop(vec3 at) {
  float r = length(at.xz);
  float turn = atan(at.z, at.x);
  float swirl = 0.5 + 0.5 * sin(r * 26.0 + 2.2 * sin(turn * 3.0));
  vec3 colour = vec3(0.90, 0.88, 0.90) * (0.92 + 0.06 * swirl + 0.05 * fractal(at.xz * 9.0));
  // A ring of piped rosettes, no two alike, and raspberries between them.
  float cells = 34.0;
  float along = (fract(turn / 6.2832 * cells) - 0.5) * 6.2832 * (uCake.x - 0.15) / cells;
  vec2 rose = vec2(along, r - (uCake.x - 0.155)) / 0.158;
  float high = 1.0 - dot(rose, rose);
  float piped = smoothstep(0.0, 0.12, high);
  float which = floor(turn / 6.2832 * cells);
  float berry = step(0.5, fract(which / 3.0 + 0.01) * 1.5) * step(fract(which / 3.0 + 0.01), 0.5);
  float chance = hash1(vec2(which, 11.0));
  float curl = 0.82 + 0.18 * sin((8.0 + 2.5 * chance) * length(rose) + 2.0 * atan(rose.y, rose.x) + 6.28 * chance);
  colour *= 1.0 - 0.35 * smoothstep(-0.5, 0.0, high) * (1.0 - piped);
  vec3 sugar = mix(vec3(0.86, 0.42, 0.50), vec3(0.93, 0.78, 0.76), chance);
  vec2 seeds = fract(rose * 3.4 + vec2(0.5 * floor(rose.y * 3.4), 0.0)) - 0.5;
  vec3 fruit = vec3(0.50, 0.030, 0.085) * (0.62 + 0.75 * smoothstep(0.5, 0.1, length(seeds)));
  colour = mix(colour, mix(sugar * curl, fruit, berry) * (0.55 + 0.47 * sqrt(max(0.0, high))), piped);
  vec2 cell = floor(at.xz * 7.5);
  vec2 in_cell = fract(at.xz * 7.5) - 0.5;
  float angle = hash1(cell + 5.0) * 6.28;
  vec2 q = mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * (in_cell - 0.3 * (vec2(hash1(cell), hash1(cell + 9.0)) - 0.5));
  float sprinkle = (1.0 - smoothstep(0.045, 0.09, length(vec2(max(abs(q.x) - 0.16, 0.0), q.y)))) * step(0.62, hash1(cell + 2.0));
  vec3 hue = 0.50 + 0.36 * cos(6.28 * (hash1(cell + 1.0) + vec3(0.0, 0.33, 0.67)));
  return vec4(mix(colour, hue, sprinkle * (1.0 - piped)), 0.25);
}

vec4 cakeSide(vec3 at) {
  float turn = atan(at.z, at.x);
  float run = turn * 13.0 + 0.9 * sin(turn * 5.0);
  float drop = 0.17 + (0.10 + 0.26 * hash1(vec2(floor(run / 6.2832 + 0.25), 4.0))) * pow(0.5 + 0.5 * sin(run), 1.6);
  float below = uCake.y - at.y;
  float icing = 1.0 - smoothstep(drop - 0.010, drop + 0.010, below);
  float crumb = fractal(vec2(turn * 22.0, at.y * 24.0));
  vec3 sponge = mix(vec3(0.25, 0.115, 0.060), vec3(0.46, 0.250, 0.140), crumb);
  float layer = smoothstep(0.045, 0.03, abs(at.y - 0.46 * uCake.y + 0.012 * crumb));
  sponge = mix(sponge, vec3(0.84, 0.78, 0.74), layer);
  // Thick cream: rounded towards its lower edge, which shades the sponge.
  vec3 cream = vec3(0.86, 0.86, 0.92) * (0.62 + 0.38 * smoothstep(0.0, 0.10, drop - below));
  sponge *= 0.55 + 0.45 * smoothstep(0.0, 0.10, below - drop);
  float foot = smoothstep(0.20, 0.17, at.y) * (0.55 + 0.45 * abs(sin(turn * 19.0)));
  return vec4(mix(mix(sponge, cream, icing), vec3(0.84, 0.55, 0.60), foot), 0.40 * icing);
}

// A plaque of white chocolate that leans on the side, with a name in dark chocolate.
vec4 plaque(vec3 at, vec4 side) {
  vec2 p = vec2((1.5708 - atan(at.z, at.x)) * uCake.x, at.y - 0.44);
  vec2 out_ = abs(p) - uPlaque + 0.07;
  float edge = length(max(out_, 0.0)) + min(max(out_.x, out_.y), 0.0) - 0.07;
  if (uPlaque.x <= 0.0 || edge > 0.05) return side;
  vec4 shadow = vec4(side.rgb * mix(0.35, 1.0, smoothstep(0.0, 0.05, edge)), side.a);
  float rim = smoothstep(-0.030, -0.012, edge) * smoothstep(0.0, -0.008, edge);
  vec3 white = vec3(0.92, 0.84, 0.70) * (0.90 + 0.10 * smoothstep(0.0, -0.05, edge)) + 0.10 * rim;
  float ink = texture(uName, 0.5 + 0.5 * p / (uPlaque * vec2(0.94, 0.94))).a;
  return mix(vec4(mix(white, vec3(0.10, 0.036, 0.016), ink), 0.35), shadow, smoothstep(-0.006, 0.006, edge));
}

vec4 cakeSurface(Hit hit) {
  vec3 at = hit.at - vec3(uCake.z, 0, 0);
  if (hit.kind == kOnCakeTop) return cakeTop(at);
  if (hit.kind == kOnCakeSide) return plaque(at, cakeSide(at));
  float rim = length(at.xz) - uCake.x;
  return vec4(mix(vec3(0.40, 0.41, 0.45), vec3(0.52, 0.36, 0.13), smoothstep(0.022, 0.008, abs(rim - 0.285))), 1.0);
}

// How much of a flame's light comes past the candles: each throws a streak that grows softer away from its foot.
float sticks(vec3 at, vec3 lamp) {
  float seen = 1.0;
  vec2 way = lamp.xz - at.xz;
  float far = length(way);
  way /= max(1e-3, far);
  float climb = (lamp.y - at.y) / max(1e-3, far);
  for (int k = 0; k < 12; ++k) {
    vec2 to = uSticks[k].xy - at.xz;
    float along = dot(to, way);
    float across = abs(to.x * way.y - to.y * way.x);
    float soft = 0.02 + 0.10 * max(0.0, along);
    float high = climb * along - uSticks[k].w;
    float dark = smoothstep(uSticks[k].z + soft, max(0.0, uSticks[k].z - soft), across) * uSticks[k].z / (uSticks[k].z + 0.5 * soft);
    seen *= 1.0 - 0.80 * dark * step(0.0, along) * smoothstep(far + 0.02, far - 0.10, along) * smoothstep(0.05, -0.15, high);
  }
  return seen;
}
`;
