export default /* glsl */ `
layout(location = 0) in vec2 corner;
out vec2 vAt;
void main() { vAt = 0.5 + 0.5 * corner; gl_Position = vec4(corner, 0, 1); }
`;
