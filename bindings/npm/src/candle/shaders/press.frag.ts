export default /* glsl */ `
// One Jacobi iteration of the pressure that makes the flow divergence-free; stored in x of its texture.
uniform sampler2D uFlow, uPressure;
void main() {
  vec2 x = vec2(uCell.x, 0), y = vec2(0, uCell.y);
  float piled = texture(uFlow, vAt + x).x - texture(uFlow, vAt - x).x + texture(uFlow, vAt + y).y - texture(uFlow, vAt - y).y;
  float around = texture(uPressure, vAt + x).x + texture(uPressure, vAt - x).x + texture(uPressure, vAt + y).x + texture(uPressure, vAt - y).x;
  colour = vec4(0.25 * (around - 0.5 * piled), 0, 0, 1);
}
`;
