export default /* glsl */ `
// Tone mapping: glare, adaptation, a filmic curve of luminance, and grain against banding of dark walls.
uniform sampler2D uPicture, uGlare, uAir;
uniform vec2 uSize;
uniform float uFade, uExposure, uGlaring, uShimmer, uClock, uClear;
out vec4 colour;

// Narkowicz's fit (2015) of the ACES film curve, applied to luminance.
float film(float l) { return clamp(l * (2.51 * l + 0.03) / (l * (2.43 * l + 0.59) + 0.14), 0.0, 1.0); }

void main() {
  vec2 at = gl_FragCoord.xy / uSize;
  if (uShimmer > 0.0) {
    float heat = min(1.0, texture(uAir, at).z);
    vec2 p = vec2(at.x * uSize.x / uSize.y, at.y) * 34.0 - vec2(0.0, 5.0 * uClock);
    at += heat * uShimmer * vec2(noise(p) - 0.5, 0.5 * (noise(p + 17.0) - 0.5));
  }
  vec4 picture = texture(uPicture, at);
  vec3 light = mix(picture.rgb, texture(uGlare, at).rgb, uGlaring);
  vec2 off = (at - vec2(0.5, 0.52)) * vec2(min(1.0, uSize.x / uSize.y), 1.0);
  light *= uFade * uExposure * (uClear > 0.0 ? 1.0 : 1.0 - 0.60 * smoothstep(0.15, 0.95, length(off) * 1.25));
  float l = dot(light, vec3(0.2126, 0.7152, 0.0722));
  float seen = film(l);
  vec3 made = light * (seen / max(l, 1e-5));
  // Colours beyond the gamut fade to white instead of clipping.
  float most = max(made.r, max(made.g, made.b));
  if (most > 0.82) {
    float limit = 1.0 - 0.18 * exp((0.82 - most) / 0.18);
    made = mix(seen * vec3(1.0, 0.965, 0.87), made, clamp((limit - seen) / max(1e-4, most - seen), 0.0, 1.0));
  }
  made = pow(clamp(made, 0.0, 1.0), vec3(1.0 / 2.2));
  float alpha = uClear > 0.0 ? max(picture.a, max(made.r, max(made.g, made.b))) : 1.0;
  if (uClear == 0.0) made += (hash1(gl_FragCoord.xy) + hash1(gl_FragCoord.yx + 71.0) - 1.0) / 255.0;
  colour = vec4(made, alpha);
}
`;
