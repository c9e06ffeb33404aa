export default /* glsl */ `
// A table with nothing on it but candles: what cake.glsl says of a cake, said of none.
#define SAMPLES 1
Hit hitOf(vec2 pixel) { return roomHit((pixel - uView.xy) / uView.z); }
vec4 cakeSurface(Hit hit) { return vec4(0); }
float sticks(vec3 at, vec3 lamp) { return 1.0; }
`;
