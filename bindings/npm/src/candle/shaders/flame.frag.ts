export default /* glsl */ `
// A flame, filled from its outline.
//
// Depth below the outline is the signed L1 distance of Belyaev, Fayolle and Pasko (2013), whose normaliser is that of
// mean value coordinates (Floater 2003): exact at the outline, smooth everywhere inside. Between two straight sides it
// is a parabola, so its root is the chord of a round body: how much glowing gas is in view. The same sum carries the
// outline's own height inwards, so that colours bend with the flame.
uniform vec3 uOutline[64];  // x, y, height along the outline: 0 at the base, 1 at the tip
uniform int uPoints;
uniform float uPixel, uBright, uSoot, uWidth, uClock, uSeed;
in vec2 vAt;
out vec4 colour;

void main() {
  float sum = 0.0, carried = 0.0, nearest = 1e9;
  int around = 0;
  vec3 last = uOutline[uPoints - 1];
  vec2 a = last.xy - vAt;
  float ra = max(1e-5, length(a));
  for (int k = 0; k < uPoints; ++k) {
    vec3 next = uOutline[k];
    vec2 b = next.xy - vAt;
    float rb = max(1e-5, length(b));
    float turned = b.x * a.y - b.y * a.x;
    float turn = turned / max(1e-7, ra * rb + dot(a, b));
    sum += turn * (1.0 / ra + 1.0 / rb);
    carried += turn * (last.z / ra + next.z / rb);
    if ((a.y > 0.0) != (b.y > 0.0) && (turned > 0.0) == (a.y > b.y)) around += a.y > 0.0 ? 1 : -1;
    vec2 way = b - a;
    nearest = min(nearest, length(a - way * clamp(dot(a, way) / max(1e-9, dot(way, way)), 0.0, 1.0)));
    last = next;
    a = b;
    ra = rb;
  }
  // Winding number decides inside, so that a fold makes neither hole nor speck.
  float depth = around == 0 ? -nearest : clamp(2.0 / max(sum, 1e-4), 0.25 * nearest, 1.1 * nearest);
  if (depth < -2.0 * uPixel - 0.02) discard;
  float t = clamp(sum > 1e-4 ? carried / sum : vAt.y, 0.0, 1.2);

  // Rising gas: visible at the edge, in the tip, and as a faint unrest inside.
  vec2 gas = vec2(vAt.x * 9.0 + uSeed, vAt.y * 3.2 - 2.6 * uClock);
  float stir = noise(gas) - 0.5 + 0.5 * (noise(gas * 2.3 + 3.1) - 0.5);
  depth += stir * (0.004 + 0.022 * smoothstep(0.62, 1.0, t));
  float soft = 0.008 + 0.020 * smoothstep(0.3, 1.0, t);
  float inside = smoothstep(-uPixel, uPixel + soft, depth);
  float thick = sqrt(clamp(2.0 * depth / uWidth, 0.0, 1.6));

  // Low down only the inside of the blue mantle has glowing soot; at the tip soot burns off.
  float shell = 0.50 * (1.0 - smoothstep(0.04, 0.34, t));
  float soot = max(0.0, thick - shell) / (1.0 - shell);
  float rise = 0.012 + 0.20 * smoothstep(0.06, 0.22, t) + 0.79 * smoothstep(0.14, 0.46, t);
  float off = 1.0 - 0.62 * smoothstep(0.66, 1.05, t);
  float glow = uSoot * soot * rise * off * (1.0 + 0.30 * stir);
  // The dark zone around the wick.
  vec2 wick = (vAt - vec2(0.012, 0.085)) / vec2(0.062, 0.13);
  glow *= 1.0 - 0.80 * exp(-dot(wick, wick));
  vec3 fire = mix(vec3(1.0, 0.235, 0.016), vec3(1.0, 0.46, 0.105), smoothstep(0.02, 0.35, glow));
  fire = mix(fire, vec3(1.0, 0.66, 0.30), smoothstep(0.25, 0.85, glow));
  vec3 lit = fire * (0.42 * glow + 9.5 * glow * glow);
  // The thin blue mantle, brightest edge-on.
  vec2 thread = (vAt - vec2(0.008, 0.02)) / vec2(0.036, 0.12);
  float mantle = (1.0 - 0.94 * exp(-dot(thread, thread))) * exp(-9.0 * (thick - 0.12) * (thick - 0.12)) * (1.0 - smoothstep(0.03, 0.30, t));
  lit += vec3(0.045, 0.15, 0.80) * mantle * 0.36;
  lit += vec3(0.30, 0.10, 0.30) * 0.05 * exp(-8.0 * thick * thick) * smoothstep(0.14, 0.3, t) * (1.0 - smoothstep(0.3, 0.55, t));
  // Soot hides part of the background.
  colour = vec4(lit, clamp(0.55 * glow, 0.0, 0.6)) * inside * uBright;
}
`;
