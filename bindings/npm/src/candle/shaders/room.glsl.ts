export default /* glsl */ `
// A room with a table, seen horizontally by an eye at height uEye, uView.w in front of z = 0.
uniform vec4 uView;     // pixel of x = 0, pixel of the eye's height, pixels per unit at z = 0, distance of the eye
uniform float uEye;     // height of the eye over the table
uniform vec3 uCake;     // radius, height, x of its middle; radius 0: no cake
uniform float uTurn;    // rotation of the eye round the table, radians

const float kWall = -4.6;
const float kOnWall = 0.0, kOnTable = 1.0, kOnPlate = 2.0, kOnCakeTop = 3.0, kOnCakeSide = 4.0;

struct Hit { vec3 at; vec3 normal; float kind; };

// Position on the table in the unrotated frame.
vec2 before(vec2 at) { return vec2(cos(uTurn) * at.x + sin(uTurn) * at.y, cos(uTurn) * at.y - sin(uTurn) * at.x); }

vec3 onRay(vec2 way, float k) { return vec3(way.x * k, uEye + way.y * k, uView.w * (1.0 - k)); }

Hit roomHit(vec2 way) {
  float wall = (uView.w - kWall) / uView.w;
  float table = way.y < 0.0 ? -uEye / way.y : 1e9;
  if (table < wall) return Hit(onRay(way, table), vec3(0, 1, 0), kOnTable);
  return Hit(onRay(way, wall), vec3(0, 0, 1), kOnWall);
}
`;
