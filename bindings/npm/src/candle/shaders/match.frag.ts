export default /* glsl */ `
// A match: its head's centre at the origin, the stick down to the right.
uniform float uPixel, uBurnt, uRoom, uFlare;
in vec2 vAt;
out vec4 colour;
void main() {
  vec2 way = normalize(vec2(0.55, -0.84));
  float along = dot(vAt, way);
  float across = vAt.x * way.y - vAt.y * way.x;
  float bent = abs(across + 0.02 * uBurnt * smoothstep(0.25, 0.0, along));
  float stick = max(bent - 0.024 * mix(1.0, 0.75, uBurnt * smoothstep(0.3, 0.0, along)), max(-along, along - 1.05));
  float head = length(vec2(along * 0.66, bent)) - mix(0.044, 0.034, uBurnt);
  float d = min(stick, head);
  float alpha = smoothstep(uPixel, -uPixel, d);
  vec3 wood = vec3(0.44, 0.29, 0.16) * (0.75 + 0.25 * noise(vec2(along * 16.0, across * 120.0)));
  float charred = smoothstep(0.30, 0.05, along + 0.05 * noise(vAt * 40.0)) * uBurnt;
  float round_ = 0.55 + 0.45 * cos(across * 58.0);
  vec3 fire = vec3(1.0, 0.46, 0.13);
  vec3 lit = wood * (vec3(0.05, 0.07, 0.12) + fire * round_ * (3.2 * uRoom / (1.0 + 0.8 * uRoom) + uBurnt * 1.4 * exp(-along * 2.6)));
  vec3 red = vec3(0.42, 0.035, 0.022) * (0.6 + 0.4 * noise(vAt * 70.0));
  lit = mix(lit, red * (0.12 + 2.6 * uRoom * round_), smoothstep(0.010, -0.004, head) * (1.0 - uBurnt));
  lit = mix(lit, vec3(0.010) + vec3(2.2, 0.34, 0.03) * uBurnt * smoothstep(0.12, 0.0, along) * noise(vAt * 60.0), charred);
  // The head ignites: briefly white, with sparks around it.
  float far = length(vAt - vec2(0.0, 0.03));
  float rays = 0.5 + 0.9 * noise(vec2(atan(vAt.y, vAt.x) * 5.0, 9.0 * uFlare));
  vec3 flare = vec3(1.0, 0.62, 0.30) * uFlare * smoothstep(0.47, 0.2, far) * (9.0 * exp(-far * far / 0.010) + 1.2 * rays * exp(-far * 9.0));
  colour = vec4(lit * alpha + flare, alpha);
}
`;
