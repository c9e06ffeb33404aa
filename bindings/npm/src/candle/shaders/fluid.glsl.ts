export default /* glsl */ `
// Air in the picture plane: units are picture heights and seconds; x from 0 to uAspect, y from 0 to 1.
uniform vec2 uCell;      // cell size of the air's grid, texture coordinates
uniform float uAspect, uSeconds;
in vec2 vAt;
out vec4 colour;
`;
