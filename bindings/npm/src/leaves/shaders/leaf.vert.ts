export default /* glsl */ `
layout(location = 0) in vec3 place;  // in halves of width and length
layout(location = 1) in vec2 veins;  // across −1 … 1, along 0 … 1
uniform vec3 uEye;
out vec2 vVeins;
out vec3 vNormal;
out vec3 vPlace;
flat out vec4 vChance;

vec4 chanceOf(float k) { return fract(sin(vec4(k * 12.9898, k * 78.233, k * 39.425, k * 93.989)) * 43758.5453); }

void main() {
  vChance = chanceOf(float(gl_InstanceID) + 1.0);
  float size = (0.72 + 0.5 * vChance.x) * smoothstep(0.0, 1.0, where.w);
  float broad = vChance.y > 0.34 && vChance.y < 0.60 ? 1.35 : 1.0 + 0.2 * vChance.z;
  float curl = 0.5 + 1.1 * vChance.z;
  vec3 local = vec3(place.x * uHalfSize.x * broad, place.y * uHalfSize.y, place.z * uHalfSize.x * curl) * size;
  vec4 q = normalize(attitude);
  vec3 at = where.xyz + turned(q, local);
  // Keeps lying leaves above the ground.
  at.z = max(at.z, 0.002 + 0.0015 * vChance.w);
  vec3 bent = normalize(vec3(-0.24 * curl * sign(place.x) * min(1.0, abs(veins.x) * 4.0), 0.34 * curl * (veins.y - 0.45), 1.0));
  vNormal = turned(q, bent);
  vVeins = veins;
  vPlace = at;
  gl_Position = uMatrix * vec4(at, 1);
}
`;
