export default /* glsl */ `
// A table without a cake: the functions of cake.glsl for the empty case.
#define SAMPLES 1
Hit hitOf(vec2 pixel) { return roomHit((pixel - uView.xy) / uView.z); }
vec4 cakeSurface(Hit hit) { return vec4(0); }
float sticks(vec3 at, vec3 lamp) { return 1.0; }
`;
