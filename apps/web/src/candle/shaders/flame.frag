// A flame, filled from its outline.
//
// Depth below the outline is the signed L1 distance of Belyaev, Fayolle and Pasko (2013), whose normaliser is that of
// mean value coordinates (Floater 2003): exact at the outline, smooth everywhere inside. Between two straight sides it
// is a parabola, so its root is the chord of a round body: how much glowing gas is in view. The same sum carries the
// outline's own height inwards, so that colours bend with the flame.
uniform vec3 uOutline[64];  // x, y, height along the outline: 0 at the base, 1 at the tip
uniform int uPoints;
uniform float uPixel, uBright, uSoot, uWidth;
in vec2 vAt;
out vec4 colour;

void main() {
  float sum = 0.0, carried = 0.0;
  vec3 last = uOutline[uPoints - 1];
  vec2 a = last.xy - vAt;
  float ra = max(1e-5, length(a));
  for (int k = 0; k < uPoints; ++k) {
    vec3 next = uOutline[k];
    vec2 b = next.xy - vAt;
    float rb = max(1e-5, length(b));
    float turn = (b.x * a.y - b.y * a.x) / max(1e-7, ra * rb + dot(a, b));
    sum += turn * (1.0 / ra + 1.0 / rb);
    carried += turn * (last.z / ra + next.z / rb);
    last = next;
    a = b;
    ra = rb;
  }
  float depth = 2.0 / (abs(sum) < 1e-4 ? 1e-4 : sum);
  if (depth < -3.0 * uPixel || sum < 0.0 && depth < -0.06) discard;
  float t = clamp(carried / sum, 0.0, 1.2);
  if (sum <= 0.0) t = clamp(vAt.y, 0.0, 1.2);
  float inside = smoothstep(-uPixel, 1.5 * uPixel + 0.010 + 0.014 * t, depth);
  float thick = sqrt(clamp(2.0 * depth / uWidth, 0.0, 1.6));

  // Low down soot glows only inside the blue mantle; at the tip it burns off.
  float shell = 0.46 * (1.0 - smoothstep(0.04, 0.36, t));
  float soot = max(0.0, thick - shell) / (1.0 - shell);
  float rise = 0.03 + 0.34 * smoothstep(0.05, 0.24, t) + 0.63 * smoothstep(0.15, 0.50, t);
  float off = 1.0 - 0.50 * smoothstep(0.74, 1.05, t);
  float glow = uSoot * soot * rise * off;
  vec3 fire = mix(vec3(1.0, 0.20, 0.012), vec3(1.0, 0.40, 0.045), smoothstep(0.05, 0.45, glow));
  fire = mix(fire, vec3(1.0, 0.66, 0.22), smoothstep(0.38, 0.95, glow));
  vec3 lit = fire * (0.62 * smoothstep(0.0, 0.32, glow) + 2.3 * glow * glow + 1.5 * glow * glow * glow);
  // The dark zone around the wick.
  vec2 wick = (vAt - vec2(0.01, 0.10)) / vec2(0.075, 0.14);
  lit *= 1.0 - 0.62 * exp(-dot(wick, wick));
  float mantle = (exp(-5.0 * thick * thick) + 0.10) * (1.0 - smoothstep(0.02, 0.34, t));
  lit += vec3(0.050, 0.19, 0.88) * mantle * 0.78;
  lit += vec3(0.25, 0.10, 0.36) * 0.20 * exp(-7.0 * thick * thick) * smoothstep(0.12, 0.3, t) * (1.0 - smoothstep(0.3, 0.6, t));
  colour = vec4(lit * inside * uBright, 0);
}
