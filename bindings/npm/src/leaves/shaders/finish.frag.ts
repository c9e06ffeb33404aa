export default /* glsl */ `
uniform sampler2D uPicture;
uniform vec2 uSize;
uniform float uFade;
out vec4 colour;
void main() {
  vec2 at = gl_FragCoord.xy / uSize;
  vec3 light = texture(uPicture, at).rgb;
  vec2 off = at - 0.5;
  light *= 1.0 - 0.42 * smoothstep(0.22, 0.85, length(off));
  light = light * light * (1.06 - 0.30 * light) * 0.62 + light * 0.52;
  light = mix(vec3(0.03, 0.03, 0.04), light, uFade);
  colour = vec4(light + (hash1(gl_FragCoord.xy) - 0.5) / 255.0, 1);
}
`;
