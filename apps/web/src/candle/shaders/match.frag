// A match: the middle of its head at the origin, the stick down to the right.
uniform float uPixel, uBurnt, uRoom;
in vec2 vAt;
out vec4 colour;
void main() {
  vec2 way = normalize(vec2(0.55, -0.84));
  float along = dot(vAt, way);
  float across = abs(vAt.x * way.y - vAt.y * way.x);
  float stick = max(across - 0.026, max(-along, along - 1.05));
  float head = length(vec2(along * 0.72, across)) - 0.046;
  float d = min(stick, head);
  float alpha = smoothstep(uPixel, -uPixel, d);
  vec3 wood = vec3(0.42, 0.27, 0.14) * (0.7 + 0.3 * noise(vec2(along * 30.0, across * 90.0)));
  float charred = smoothstep(0.26, 0.06, along) * uBurnt;
  vec3 round = vec3(1.0, 0.55, 0.22) * (0.75 + 0.25 * cos(across * 60.0));
  vec3 lit = wood * (vec3(0.03, 0.04, 0.06) + round * (uRoom + uBurnt * 1.2 * exp(-along * 2.4)));
  lit = mix(lit, vec3(0.75, 0.08, 0.05) * (0.05 + 0.9 * uRoom), smoothstep(0.012, -0.004, head) * (1.0 - uBurnt));
  lit = mix(lit, vec3(0.015) + vec3(0.9, 0.2, 0.03) * 0.3 * smoothstep(0.1, 0.0, along), charred);
  colour = vec4(lit, 1) * alpha;
}
