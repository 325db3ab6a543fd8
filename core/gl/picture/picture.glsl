// The triangles of a picture, shaded on the CPU (core/gl/picture/picture.cpp).
#ifdef FAR_VERTEX
// A corner: x, y and depth in normalized device coordinates, and its colour, RGBA8 in 32 bits.
layout(std430, binding = 0) readonly buffer Corners { uvec4 corners[]; };

flat out vec4 v_colour;

void main() {
  uvec4 corner = corners[gl_VertexID];
  v_colour = unpackUnorm4x8(corner.w);
  gl_Position = vec4(uintBitsToFloat(corner.xyz), 1.0);
}
#else
flat in vec4 v_colour;
out vec4 o_colour;

void main() { o_colour = v_colour; }
#endif
