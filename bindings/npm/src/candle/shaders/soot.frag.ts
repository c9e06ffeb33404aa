export default /* glsl */ `
// Advects the density of smoke.
uniform sampler2D uFlow, uSmoke, uWish;
uniform vec4 uWishBox;    // area of smoke writing: centre, half width and half height; 0: none
uniform vec4 uWicks[14];  // position, width and strength of each smoking wick
uniform int uCount;
void main() {
  vec2 flow = texture(uFlow, vAt).xy / vec2(uAspect, 1);
  // Midpoint method, which keeps threads thin.
  vec2 half_ = texture(uFlow, vAt - 0.5 * uSeconds * flow).xy / vec2(uAspect, 1);
  float smoke = texture(uSmoke, vAt - uSeconds * half_).x * exp(-0.42 * uSeconds);
  vec2 at = vAt * vec2(uAspect, 1);
  for (int k = 0; k < uCount; ++k) {
    // Smoke of this step lies along the air's path from the wick, whatever the step's length.
    vec2 way = uSeconds * texture(uFlow, uWicks[k].xy / vec2(uAspect, 1)).xy;
    vec2 to = at - uWicks[k].xy;
    float along = clamp(dot(to, way) / max(1e-7, dot(way, way)), 0.0, 1.0);
    vec2 off = (to - along * way) / uWicks[k].z;
    smoke += uSeconds * uWicks[k].w * exp(-dot(off, off)) / (1.0 + length(way) / uWicks[k].z);
  }
  if (uWishBox.w > 0.0) {
    vec2 in_ = 0.5 + 0.5 * (at - uWishBox.xy) / uWishBox.zw;
    if (in_ == clamp(in_, 0.0, 1.0)) smoke += 6.0 * uSeconds * texture(uWish, in_).a * max(0.0, 1.4 - smoke);
  }
  colour = vec4(max(0.0, smoke - 0.004 * uSeconds), 0, 0, 1);
}
`;
