export default /* glsl */ `
// A rectangle facing the eye at a foot in the room; vAt is the position on it, relative to the foot, in board units.
uniform vec4 uView;
uniform float uEye;
uniform vec3 uFoot;   // in the room
uniform vec4 uBox;    // left, bottom, right, top, relative to the foot, board units
uniform float uUnit;  // room units per board unit
uniform vec2 uSize;   // picture size, pixels
layout(location = 0) in vec2 corner;
out vec2 vAt;
void main() {
  vAt = mix(uBox.xy, uBox.zw, 0.5 + 0.5 * corner);
  float near = uView.w / (uView.w - uFoot.z);
  vec2 place = vec2(uFoot.x + vAt.x * uUnit, uFoot.y + vAt.y * uUnit - uEye);
  vec2 pixel = uView.xy + place * near * uView.z;
  gl_Position = vec4(2.0 * pixel / uSize - 1.0, 0, 1);
}
`;
