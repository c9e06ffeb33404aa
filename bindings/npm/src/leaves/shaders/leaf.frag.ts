export default /* glsl */ `
uniform vec3 uEye;
in vec2 vVeins;
in vec3 vNormal;
in vec3 vPlace;
flat in vec4 vChance;
out vec4 colour;

const vec3 kSun = vec3(-0.52, 0.62, 0.59);

vec3 hue(float k) {
  if (k < 0.30) return mix(vec3(0.80, 0.30, 0.055), vec3(0.90, 0.42, 0.07), k / 0.30);
  if (k < 0.58) return mix(vec3(0.88, 0.58, 0.10), vec3(0.93, 0.72, 0.20), (k - 0.30) / 0.28);
  if (k < 0.80) return mix(vec3(0.62, 0.13, 0.06), vec3(0.76, 0.20, 0.06), (k - 0.58) / 0.22);
  if (k < 0.92) return mix(vec3(0.50, 0.30, 0.13), vec3(0.60, 0.38, 0.16), (k - 0.80) / 0.12);
  return mix(vec3(0.48, 0.52, 0.14), vec3(0.66, 0.62, 0.16), (k - 0.92) / 0.08);
}

void main() {
  Blade leaf = blade(vVeins, vChance.y);
  float far = length(vPlace - uEye);
  // Defocus blurs the edges of very near leaves.
  float soft_edge = fwidth(leaf.inside) + 0.30 * smoothstep(1.5, 0.5, far);
  float alpha = smoothstep(-0.5 * soft_edge, 0.5 * soft_edge, leaf.inside);
  if (alpha < 0.02) discard;
  vec3 normal = normalize(vNormal);
  vec3 eye = normalize(uEye - vPlace);
  bool upper = dot(normal, eye) > 0.0;
  vec3 facing = upper ? normal : -normal;
  vec3 body = hue(fract(vChance.w + 0.31 * vChance.y));
  body = mix(body, vec3(dot(body, vec3(0.35, 0.5, 0.15))), 0.16);
  // Spots of age.
  body *= 1.0 - 0.30 * smoothstep(0.62, 0.80, noise(vVeins * vec2(7.0, 13.0) + 40.0 * vChance.xy)) * vChance.z;
  float across = leaf.across;
  float edge = smoothstep(0.45, 1.0, across + 0.25 * (vChance.x - 0.5));
  body = mix(body, body * vec3(0.74, 0.55, 0.55), 0.8 * edge);
  float ribs = abs(fract(vVeins.y * 7.0 - across * 1.5) - 0.5) * 2.0;
  float soft = fwidth(vVeins.y * 7.0 - across * 1.5) * 2.0;
  float side = smoothstep(0.20 + soft, 0.04, 1.0 - ribs) * (1.0 - smoothstep(0.75, 1.0, across)) * (1.0 - smoothstep(0.25, 0.7, soft));
  float middle = smoothstep(0.10 + 2.0 * fwidth(vVeins.x), 0.03, across);
  float vein = max(0.55 * side, middle);
  vec3 skin = upper ? body : mix(body, vec3(0.72, 0.60, 0.44), 0.45);
  skin = mix(skin, mix(skin, vec3(0.95, 0.80, 0.50), 0.62), vein);
  float sun = max(0.0, dot(facing, kSun));
  float through = max(0.0, -dot(facing, kSun));
  vec3 sky = mix(vec3(0.42, 0.36, 0.28), vec3(0.72, 0.74, 0.74), 0.5 + 0.5 * facing.z);
  vec3 lit = skin * (vec3(1.32, 1.16, 0.90) * sun + 0.62 * sky);
  lit += skin * skin * vec3(1.9, 1.5, 0.7) * through * (1.0 - 0.45 * vein) * 1.25;
  vec3 half_way = normalize(eye + kSun);
  lit += vec3(1.0, 0.88, 0.66) * 0.30 * pow(max(0.0, dot(facing, half_way)), 26.0);
  float mist = 1.0 - exp(-pow(far / 9.5, 2.0));
  colour = vec4(mix(lit, vec3(0.93, 0.80, 0.60), mist), alpha);
}
`;
