export default /* glsl */ `
// Air in the plane of the picture: heights of the picture, seconds. x runs to uAspect, y to 1.
uniform vec2 uCell;      // of the grid of the air, in texture coordinates
uniform float uAspect, uSeconds;
in vec2 vAt;
out vec4 colour;
`;
