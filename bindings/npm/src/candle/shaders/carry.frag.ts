export default /* glsl */ `
// Advects velocity and heat, and applies forces of heat, breath and hand: Stam, Stable Fluids (1999), with the
// vorticity confinement of Fedkiw, Stam and Jensen (2001).
uniform sampler2D uFlow;
uniform vec4 uHeats[14];  // position, width and heat of each flame or ember
uniform int uCount;
uniform vec4 uHand;       // position and velocity of the pointer
uniform vec2 uBreath;     // velocity and height of the breath
uniform float uHandReach, uClock;

vec4 flow(vec2 at) { return texture(uFlow, at); }
float curl(vec2 at) {
  return flow(at + vec2(uCell.x, 0)).y - flow(at - vec2(uCell.x, 0)).y - flow(at + vec2(0, uCell.y)).x + flow(at - vec2(0, uCell.y)).x;
}

void main() {
  vec4 here = flow(vAt);
  vec2 from = vAt - uSeconds * here.xy / vec2(uAspect, 1);
  vec4 now = flow(from);
  vec2 at = vAt * vec2(uAspect, 1);
  // Drag: a puff decays quickly in room air.
  now.xy /= 1.0 + uSeconds * vec2(1.6 + 2.4 * abs(now.x), 0.30);
  now.z *= exp(-1.5 * uSeconds);
  for (int k = 0; k < uCount; ++k) {
    vec2 off = (at - uHeats[k].xy) / uHeats[k].z;
    now.z += uSeconds * uHeats[k].w * exp(-dot(off, off));
  }
  now.z = min(now.z, 1.6);
  now.y += uSeconds * 1.9 * now.z;
  // Vorticity confinement restores whirls that the grid smooths away.
  float c = curl(vAt);
  vec2 slope = vec2(abs(curl(vAt + vec2(uCell.x, 0))) - abs(curl(vAt - vec2(uCell.x, 0))), abs(curl(vAt + vec2(0, uCell.y))) - abs(curl(vAt - vec2(0, uCell.y))));
  now.xy += uSeconds * 9.0 * c * vec2(slope.y, -slope.x) / max(1e-4, length(slope));
  // Random draught: room air is never still.
  now.x += uSeconds * 0.10 * (noise(vec2(at.y * 3.0 - 0.35 * uClock, 0.23 * uClock)) + noise(vec2(at.y * 9.0 - 0.6 * uClock, 7.0)) - 1.0) * smoothstep(0.02, 0.3, now.z + 0.1);
  float band = exp(-pow((at.y - uBreath.y) / 0.22, 2.0));
  now.x += (uBreath.x - now.x) * band * (1.0 - exp(-9.0 * uSeconds * abs(uBreath.x)));
  vec2 hand = (at - uHand.xy) / uHandReach;
  now.xy += (uHand.zw - now.xy) * exp(-dot(hand, hand)) * (1.0 - exp(-14.0 * uSeconds * length(uHand.zw)));
  // Absorbs flow at the edges.
  vec2 wall = smoothstep(vec2(0), vec2(0.04), vAt) * smoothstep(vec2(0), vec2(0.04), 1.0 - vAt);
  colour = vec4(clamp(now.xy, -3.0, 3.0) * mix(0.9, 1.0, wall.x * wall.y), now.z, 0);
}
`;
