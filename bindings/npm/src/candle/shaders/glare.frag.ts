export default /* glsl */ `
// Glare in the eye: each picture of the chain is half the size of the one before; on the way back they are blended.
// Thirteen samples down as in Jimenez (2014), nine up.
uniform sampler2D uFrom, uFiner;
uniform vec2 uTexel;   // texel of the source picture
uniform float uSpread; // 0: down; otherwise weight of the coarser picture
out vec4 colour;
in vec2 vAt;

vec3 at(float x, float y) { return texture(uFrom, vAt + vec2(x, y) * uTexel).rgb; }

void main() {
  if (uSpread == 0.0) {
    vec3 middle = at(-1.0, -1.0) + at(1.0, -1.0) + at(-1.0, 1.0) + at(1.0, 1.0);
    vec3 edge = at(-2.0, 0.0) + at(2.0, 0.0) + at(0.0, -2.0) + at(0.0, 2.0);
    vec3 corner = at(-2.0, -2.0) + at(2.0, -2.0) + at(-2.0, 2.0) + at(2.0, 2.0);
    colour = vec4(min(vec3(40), 0.125 * middle + 0.0625 * edge + 0.03125 * corner + 0.125 * at(0.0, 0.0)), 1);
  } else {
    vec3 wide = 0.25 * at(0.0, 0.0) + 0.125 * (at(-1.0, 0.0) + at(1.0, 0.0) + at(0.0, -1.0) + at(0.0, 1.0)) +
                0.0625 * (at(-1.0, -1.0) + at(1.0, -1.0) + at(-1.0, 1.0) + at(1.0, 1.0));
    colour = vec4(mix(texture(uFiner, vAt).rgb, wide, uSpread), 1);
  }
}
`;
