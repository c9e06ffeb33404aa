uniform vec4 uView;
uniform float uEye;
uniform vec2 uSize;
layout(location = 0) in vec4 place;  // in the room; across −1 … 1
layout(location = 1) in vec2 look;   // opacity, age in seconds
out float vAcross;
out vec2 vLook;
out vec3 vPlace;
void main() {
  vAcross = place.w;
  vLook = look;
  vPlace = place.xyz;
  float near = uView.w / (uView.w - place.z);
  vec2 pixel = uView.xy + vec2(place.x, place.y - uEye) * near * uView.z;
  gl_Position = vec4(2.0 * pixel / uSize - 1.0, 0, 1);
}
