export default /* glsl */ `
// Shading of smoke: lit by flames, embers, and moonlight falling through the room.
uniform sampler2D uSmoke;
uniform vec4 uLamps[14];  // position in picture heights; reach, light
uniform int uCount;
uniform vec2 uGrain;      // texel of the smoke's grid
uniform float uMoon;
void main() {
  float dense = texture(uSmoke, vAt).x;
  if (dense < 0.003) discard;
  float alpha = 1.0 - exp(-1.15 * dense);
  vec2 at = vAt * vec2(uAspect, 1);
  // Smoke is dense, so its side facing the moon is brighter.
  float slope = texture(uSmoke, vAt + vec2(uGrain.x, 0.6 * uGrain.y)).x - texture(uSmoke, vAt - vec2(uGrain.x, 0.6 * uGrain.y)).x;
  float facing = 0.5 - 0.5 * slope / (abs(slope) + 0.10);
  // A beam from the upper left to the moonlight on the wall.
  float across = at.y - 0.62 + 0.42 * (at.x - 0.5 * uAspect);
  float shaft = 0.30 + 0.70 * smoothstep(0.30, 0.02, abs(across - 0.04));
  vec3 lit = vec3(0.36, 0.52, 0.86) * uMoon * shaft * (0.55 + 0.75 * facing);
  for (int k = 0; k < uCount; ++k) {
    vec2 off = at - uLamps[k].xy;
    lit += vec3(1.0, 0.48, 0.16) * uLamps[k].w / (1.0 + dot(off, off) / (uLamps[k].z * uLamps[k].z));
  }
  colour = vec4(lit * alpha, alpha * 0.75);
}
`;
