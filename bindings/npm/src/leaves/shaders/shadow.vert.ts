export default /* glsl */ `
// Soft shadow of a leaf: its outline projected from the sun, wider and fainter with height.
layout(location = 0) in vec2 corner;
out vec2 vAt;
out float vDark;
out float vSoft;

const vec3 kSun = vec3(-0.52, 0.62, 0.59);

vec2 onGround(vec3 at) { return at.xy - kSun.xy * (at.z / kSun.z); }

void main() {
  vec4 q = normalize(attitude);
  vec2 middle = onGround(where.xyz);
  vec2 wide = onGround(turned(q, vec3(uHalfSize.x, 0, 0)));
  vec2 along = onGround(turned(q, vec3(0, uHalfSize.y, 0)));
  float blur = 0.006 + 0.055 * max(0.0, where.z);
  float size = 0.5 * (length(wide) + length(along));
  // The grown area is at least blur², so that the shadow of an edge-on leaf stays faint.
  float area = abs(wide.x * along.y - wide.y * along.x);
  vec2 grown_wide = wide + normalize(wide + 1e-6) * blur;
  vec2 grown_along = along + normalize(along + 1e-6) * blur;
  float grown = max(abs(grown_wide.x * grown_along.y - grown_wide.y * grown_along.x), blur * blur);
  vDark = 0.62 * where.w * min(1.0, (area + 0.15 * blur * blur) / grown) * exp(-0.55 * max(0.0, where.z));
  vSoft = clamp(blur / max(1e-4, size), 0.1, 1.0);
  vAt = corner * 1.25;
  gl_Position = uMatrix * vec4(middle + corner.x * 1.25 * grown_wide + corner.y * 1.25 * grown_along, 0.001, 1);
}
`;
