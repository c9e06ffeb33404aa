export default /* glsl */ `
// Outlines of four species: depth inside the outline at x across, −1 … 1, and y along, 0 … 1; and position as a share
// of the way from midrib to edge.
struct Blade { float inside; float across; };

Blade sheet(vec2 at, float half_) { return Blade(half_ - abs(at.x), abs(at.x) / max(0.02, half_)); }

Blade birch(vec2 at) {
  float t = clamp(at.y, 0.0, 1.0);
  float saw = 0.035 * abs(fract(t * 17.0) - 0.5);
  return sheet(at, pow(sin(3.1416 * pow(t, 0.62)), 1.05) * (0.90 - 0.15 * t) + saw * step(0.03, t) - 0.02);
}

Blade oak(vec2 at) {
  float t = clamp(at.y, 0.0, 1.0);
  float lobes = 0.80 + 0.20 * cos(6.2832 * (3.6 * t + 0.10 * abs(at.x)));
  return sheet(at, pow(sin(3.1416 * pow(t, 1.25)), 0.62) * 0.86 * lobes);
}

Blade maple(vec2 at) {
  vec2 off = vec2(at.x, 1.55 * (at.y - 0.34));
  float turn = abs(atan(off.x, off.y));
  // Five lobes, the middle one longest, each with a small shoulder.
  float point = abs(fract(turn / 1.22 + 0.5) - 0.5) * 2.0;
  float reach = mix(1.02, 0.42, smoothstep(0.0, 3.0, turn)) * (0.50 + 0.50 * pow(1.0 - point, 1.35)) + 0.05 * abs(sin(13.0 * turn));
  float far = length(off);
  return Blade(0.8 * (reach - far), far / reach);
}

Blade willow(vec2 at) {
  float t = clamp(at.y, 0.0, 1.0);
  return sheet(at, 0.46 * pow(sin(3.1416 * pow(t, 0.85)), 0.9));
}

Blade blade(vec2 at, float chance) {
  Blade made;
  if (chance < 0.34) made = birch(at);
  else if (chance < 0.60) made = maple(at);
  else if (chance < 0.82) made = oak(at);
  else made = willow(at);
  float stalk = 0.035 + 0.02 * at.y - abs(at.x);
  if (at.y < 0.1 && stalk > made.inside) return Blade(stalk, 0.0);
  return made;
}
`;
