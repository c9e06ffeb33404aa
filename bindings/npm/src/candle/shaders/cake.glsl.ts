export default /* glsl */ `
// A cake on its plate: intersection with view rays, material, and shadows of its candles.
#define SAMPLES 4
uniform sampler2D uName;
uniform vec2 uPlaque;      // half width and half height; 0: no plaque
uniform vec4 uSticks[12];  // each candle on the cake: foot x, z; radius; height over the cake

// Smallest k > 0 at which a ray meets an upright cylinder; 0: none.
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
    // The plate curves up towards its edge, so its normal leans inwards.
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

// A raspberry seen from above, made of shiny drupelets; place has length 1 at its edge.
vec3 raspberry(vec2 place, float chance) {
  vec2 q = 2.7 * place + chance;
  vec2 cell = vec2(q.x + 0.5 * floor(q.y), q.y);
  vec2 off = fract(cell) - 0.5;
  float round_ = max(0.0, 1.0 - 3.4 * dot(off, off));
  vec3 fruit = mix(vec3(0.34, 0.02, 0.09), vec3(0.84, 0.16, 0.24), round_ * (0.55 + 0.45 * hash1(floor(cell))));
  fruit += vec3(0.55, 0.36, 0.36) * smoothstep(0.030, 0.0, dot(off + 0.13, off + 0.13));
  return fruit * (0.62 + 0.38 * sqrt(max(0.0, 1.0 - dot(place, place))));
}

// A rosette of cream from a star nozzle, wound either way, lit from the middle of the cake at negative place.y.
vec3 rosette(vec2 place, float chance) {
  float far = length(place);
  float ridges = cos(6.0 * atan(place.y, place.x) + (chance < 0.5 ? 7.0 : -7.0) * far + 6.28 * chance);
  vec3 sugar = mix(vec3(0.94, 0.60, 0.62), mix(vec3(0.97, 0.88, 0.78), vec3(0.90, 0.72, 0.80), step(0.7, chance)), smoothstep(0.2, 0.6, chance));
  float lit = 0.74 - 0.20 * place.y + 0.20 * ridges * smoothstep(0.05, 0.5, far) + 0.22 * exp(-9.0 * far * far);
  return sugar * lit * (0.72 + 0.28 * sqrt(max(0.0, 1.0 - far * far)));
}

vec4 cakeTop(vec3 at) {
  float r = length(at.xz);
  float turn = atan(at.z, at.x);
  float swirl = 0.5 + 0.5 * sin(r * 26.0 + 2.2 * sin(turn * 3.0));
  vec3 colour = vec3(0.93, 0.89, 0.86) * (0.92 + 0.06 * swirl + 0.05 * fractal(at.xz * 9.0));
  // A ring of different piped rosettes with raspberries between them.
  float cells = 34.0;
  float which = floor(turn / 6.2832 * cells);
  float along = (fract(turn / 6.2832 * cells) - 0.5) * 6.2832 * (uCake.x - 0.15) / cells;
  float chance = hash1(vec2(which, 11.0));
  vec2 place = vec2(along + 0.016 * (chance - 0.5), r - (uCake.x - 0.162)) / (0.142 + 0.030 * hash1(vec2(which, 5.0)));
  bool berry = mod(which, 3.0) < 0.5;
  float scallops = berry ? 0.0 : 0.07 * cos(12.0 * atan(place.y, place.x) + 6.28 * chance);
  float high = 1.0 - dot(place, place) * (1.0 + scallops);
  float piped = smoothstep(0.0, 0.10, high);
  // Rosettes and berries shade the icing on their outer side.
  vec2 behind = place - vec2(0.0, 0.22);
  colour *= 1.0 - 0.45 * smoothstep(-0.55, 0.15, 1.0 - dot(behind, behind)) * (1.0 - piped);
  colour = mix(colour, berry ? raspberry(place, chance) : rosette(place, chance), piped);
  vec2 cell = floor(at.xz * 7.5);
  vec2 in_cell = fract(at.xz * 7.5) - 0.5;
  float angle = hash1(cell + 5.0) * 6.28;
  vec2 q = mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * (in_cell - 0.3 * (vec2(hash1(cell), hash1(cell + 9.0)) - 0.5));
  float sprinkle = (1.0 - smoothstep(0.045, 0.09, length(vec2(max(abs(q.x) - 0.16, 0.0), q.y)))) * step(0.62, hash1(cell + 2.0));
  vec3 hue = 0.50 + 0.36 * cos(6.28 * (hash1(cell + 1.0) + vec3(0.0, 0.33, 0.67)));
  return vec4(mix(colour, hue, sprinkle * (1.0 - piped)), berry ? mix(0.25, 0.6, piped) : 0.25);
}

vec4 cakeSide(vec3 at) {
  float turn = atan(at.z, at.x);
  float run = turn * 13.0 + 0.9 * sin(turn * 5.0);
  float drop = 0.17 + (0.10 + 0.26 * hash1(vec2(floor(run / 6.2832 + 0.25), 4.0))) * pow(0.5 + 0.5 * sin(run), 1.6);
  float below = uCake.y - at.y;
  float icing = 1.0 - smoothstep(drop - 0.010, drop + 0.010, below);
  float crumb = fractal(vec2(turn * 22.0, at.y * 24.0));
  vec3 sponge = mix(vec3(0.34, 0.190, 0.110), vec3(0.56, 0.345, 0.210), crumb);
  float layer = smoothstep(0.045, 0.03, abs(at.y - 0.46 * uCake.y + 0.012 * crumb));
  sponge = mix(sponge, vec3(0.90, 0.82, 0.74), layer);
  // Thick cream, rounded at its lower edge, which shades the sponge; drips shine at shoulder and end.
  float inside = drop - below;
  float bulge = pow(0.5 + 0.5 * sin(run), 1.6);
  vec3 cream = vec3(0.84, 0.80, 0.77) * (0.66 + 0.34 * smoothstep(0.0, 0.09, inside)) * (0.90 + 0.10 * bulge);
  float shoulder = exp(-pow((fract(run / 6.2832 + 0.25) - 0.40) / 0.045, 2.0)) * smoothstep(0.05, 0.13, inside) * smoothstep(0.06, 0.16, below);
  float bead = exp(-pow((inside - 0.075) / 0.022, 2.0)) * smoothstep(0.72, 0.98, bulge);
  float lip = exp(-pow((below - 0.035) / 0.016, 2.0));
  cream += vec3(0.20, 0.19, 0.17) * min(1.0, shoulder + bead + 0.7 * lip);
  sponge *= 0.60 + 0.40 * smoothstep(0.0, 0.10, below - drop);
  // Pearls of cream along the foot.
  vec2 pearl = vec2(fract(turn * 13.0 / 1.5708) - 0.5, (at.y - 0.125) / 0.065 * 0.5) * 2.0;
  float ball = 1.0 - dot(pearl, pearl);
  float foot = smoothstep(-0.15, 0.05, ball) * step(at.y, 0.2);
  vec3 pink = vec3(0.98, 0.80, 0.77) * (0.60 + 0.40 * sqrt(max(0.0, ball))) + 0.12 * smoothstep(0.10, 0.0, length(pearl - vec2(-0.25, 0.35)));
  sponge *= 1.0 - 0.45 * smoothstep(0.24, 0.10, at.y);
  return vec4(mix(mix(sponge, cream, icing), pink, foot), 0.40 * icing);
}

// A plaque of white chocolate leaning on the side, with a name in dark chocolate.
vec4 plaque(vec3 at, vec4 side) {
  vec2 p = vec2((1.5708 - atan(at.z, at.x)) * uCake.x, at.y - 0.44);
  vec2 out_ = abs(p) - uPlaque + 0.07;
  float edge = length(max(out_, 0.0)) + min(max(out_.x, out_.y), 0.0) - 0.07;
  if (uPlaque.x <= 0.0 || edge > 0.05) return side;
  vec4 shadow = vec4(side.rgb * mix(0.35, 1.0, smoothstep(0.0, 0.05, edge)), side.a);
  float rim = smoothstep(-0.030, -0.012, edge) * smoothstep(0.0, -0.008, edge);
  vec3 white = vec3(0.97, 0.90, 0.79) * (0.90 + 0.10 * smoothstep(0.0, -0.05, edge)) + 0.10 * rim;
  float ink = texture(uName, 0.5 + 0.5 * p / (uPlaque * vec2(0.94, 0.94))).a;
  return mix(vec4(mix(white, vec3(0.26, 0.115, 0.065), ink), 0.35), shadow, smoothstep(-0.006, 0.006, edge));
}

vec4 cakeSurface(Hit hit) {
  vec3 at = hit.at - vec3(uCake.z, 0, 0);
  at.xz = before(at.xz);
  if (hit.kind == kOnCakeTop) return cakeTop(at);
  if (hit.kind == kOnCakeSide) return plaque(at, cakeSide(at));
  float rim = length(at.xz) - uCake.x;
  vec3 plate = mix(vec3(0.62, 0.62, 0.66), vec3(0.70, 0.48, 0.18), smoothstep(0.022, 0.008, abs(rim - 0.285)));
  // The cake is mirrored upside down in the plate's glaze.
  vec3 way = hit.at - vec3(0, uEye, uView.w);
  vec2 from = hit.at.xz - vec2(uCake.z, 0);
  vec2 flat_ = normalize(way.xz);
  float passed = uCake.x * uCake.x - dot(from, from) + pow(dot(from, flat_), 2.0);
  float reach = -dot(from, flat_) - sqrt(max(0.0, passed));
  float height = 0.06 - reach * way.y / length(way.xz);
  if (reach > 0.0 && passed > 0.0) {
    vec2 mirrored = before(from + reach * flat_);
    // The glaze is uneven: edges in it are soft, and distant parts fainter.
    float clear = smoothstep(0.36, 0.30, rim) * smoothstep(0.0, 0.30 * uCake.x * uCake.x, passed) * (1.0 - 0.7 * smoothstep(0.08, 0.40, height));
    plate = mix(plate, 0.38 * cakeSide(vec3(mirrored.x, height, mirrored.y)).rgb, 0.52 * clear);
  }
  // The plate is dark where the cake stands.
  plate *= 0.45 + 0.55 * smoothstep(0.0, 0.07, rim);
  return vec4(plate, 1.0);
}

// Share of a flame's light that passes the candles: each casts a streak that softens away from its foot.
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
