uniform vec4 uLights[14];
uniform int uCount;
in float vAcross;
in vec2 vLook;
in vec3 vPlace;
out vec4 colour;
void main() {
  float edge = 1.0 - vAcross * vAcross;
  float sheet = 0.55 * edge + 0.75 * exp(-pow((abs(vAcross) - 0.62) / 0.24, 2.0)) * edge;
  float curl = 0.70 + 0.50 * noise(vec2(vAcross * 1.7 + vLook.y * 0.7, vPlace.y * 3.1 - vLook.y * 2.0));
  float alpha = clamp(vLook.x * sheet * curl, 0.0, 1.0);
  vec3 lit = vec3(0.20, 0.25, 0.36) * 0.62;
  for (int k = 0; k < uCount; ++k) {
    vec3 to = uLights[k].xyz - vPlace;
    lit += vec3(1.0, 0.55, 0.22) * uLights[k].w / (0.7 + dot(to, to));
  }
  colour = vec4(lit * alpha, alpha * 0.8);
}
