export default /* glsl */ `
// Subtracts the pressure gradient from the velocity.
uniform sampler2D uFlow, uPressure;
void main() {
  vec2 x = vec2(uCell.x, 0), y = vec2(0, uCell.y);
  vec2 slope = 0.5 * vec2(texture(uPressure, vAt + x).x - texture(uPressure, vAt - x).x, texture(uPressure, vAt + y).x - texture(uPressure, vAt - y).x);
  vec4 flow = texture(uFlow, vAt);
  colour = vec4(flow.xy - slope, flow.zw);
}
`;
