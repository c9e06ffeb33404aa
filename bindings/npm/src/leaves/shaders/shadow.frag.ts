export default /* glsl */ `
in vec2 vAt;
in float vDark;
in float vSoft;
out vec4 colour;
void main() {
  float r = length(vec2(vAt.x * (1.0 + 0.35 * vAt.y * vAt.y), vAt.y));
  float dark = vDark * (1.0 - smoothstep(1.0 - vSoft, 1.0 + 0.25 * vSoft, r));
  colour = vec4(mix(vec3(1), vec3(0.34, 0.31, 0.38), dark), 1);
}
`;
