// A room with a table, seen straight on by an eye at height uEye, uDistance in front of z = 0. Verticals stay vertical.
uniform vec4 uView;     // pixel of x = 0, pixel of the eye's height, pixels a unit at z = 0, distance of the eye
uniform float uEye;     // height of the eye over the table
uniform vec3 uCake;     // radius, height, x of its middle; radius 0: no cake

const float kWall = -4.6;
const float kOnWall = 0.0, kOnTable = 1.0, kOnPlate = 2.0, kOnCakeTop = 3.0, kOnCakeSide = 4.0;

struct Hit { vec3 at; vec3 normal; float kind; };

vec3 onRay(vec2 way, float k) { return vec3(way.x * k, uEye + way.y * k, uView.w * (1.0 - k)); }

// First k > 0 where the ray meets the standing cylinder of that radius; 0: never.
float cylinder(vec2 way, float radius, float middle) {
  float d2 = uView.w * uView.w;
  float a = way.x * way.x + d2;
  float b = d2 + way.x * middle;
  float root = b * b - a * (d2 + middle * middle - radius * radius);
  return root < 0.0 ? 0.0 : (b - sqrt(root)) / a;
}

Hit hitOf(vec2 pixel) {
  vec2 way = (pixel - uView.xy) / uView.z;
  float wall = (uView.w - kWall) / uView.w;
  float table = way.y < 0.0 ? -uEye / way.y : 1e9;
  Hit hit = Hit(onRay(way, wall), vec3(0, 0, 1), kOnWall);
  if (table < wall) hit = Hit(onRay(way, table), vec3(0, 1, 0), kOnTable);
  if (uCake.x <= 0.0) return hit;
  vec2 middle = vec2(uCake.z, 0);
  float plate = (0.06 - uEye) / min(way.y, -1e-4);
  vec3 onPlate = onRay(way, plate);
  if (length(onPlate.xz - middle) < uCake.x + 0.34) hit = Hit(onPlate, vec3(0, 1, 0), kOnPlate);
  float top = (uCake.y - uEye) / min(way.y, -1e-4);
  vec3 onTop = onRay(way, top);
  if (length(onTop.xz - middle) < uCake.x) return Hit(onTop, vec3(0, 1, 0), kOnCakeTop);
  float side = cylinder(way, uCake.x, uCake.z);
  vec3 onSide = onRay(way, side);
  if (side > 0.0 && onSide.y < uCake.y && onSide.y > 0.06) {
    return Hit(onSide, vec3(onSide.x - uCake.z, 0, onSide.z) / uCake.x, kOnCakeSide);
  }
  return hit;
}
