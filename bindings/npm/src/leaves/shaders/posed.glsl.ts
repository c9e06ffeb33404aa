export default /* glsl */ `
// Pose of one leaf, and sizes and view that are common to all.
layout(location = 2) in vec4 where;     // metres; opacity
layout(location = 3) in vec4 attitude;  // quaternion w, x, y, z
uniform mat4 uMatrix;
uniform vec2 uHalfSize;  // half width, half length, metres

vec3 turned(vec4 q, vec3 v) {
  vec3 t = 2.0 * cross(q.yzw, v);
  return v + q.x * t + cross(q.yzw, t);
}
`;
