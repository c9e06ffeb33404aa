// From light to the screen: one exposure curve, the corners darker, and a grain that keeps dark walls from banding.
uniform sampler2D uPicture;
uniform vec2 uSize;
uniform float uFade;
out vec4 colour;
void main() {
  vec2 at = gl_FragCoord.xy / uSize;
  vec3 light = texture(uPicture, at).rgb;
  vec2 off = (at - vec2(0.5, 0.52)) * vec2(min(1.0, uSize.x / uSize.y), 1.0);
  light *= 1.0 - 0.55 * smoothstep(0.15, 0.95, length(off) * 1.25);
  light *= uFade;
  vec3 seen = 1.0 - exp(-1.15 * light);
  seen = pow(seen, vec3(1.0 / 2.2));
  seen += (hash1(gl_FragCoord.xy) + hash1(gl_FragCoord.yx + 71.0) - 1.0) / 255.0;
  colour = vec4(seen, 1);
}
