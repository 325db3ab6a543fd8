// The texels of a depth texture that a draw has written, as a shader reads them.
layout(local_size_x = 64) in;
layout(location = 0) uniform uint u_count;
layout(location = 1) uniform uint u_width;  // px
layout(location = 2) uniform sampler2D u_depth;
layout(std430, binding = 1) writeonly buffer To { uint to[]; };

void main() {
  uint w = gl_GlobalInvocationID.x;
  if (w < u_count) to[w] = floatBitsToUint(texelFetch(u_depth, ivec2(w % u_width, w / u_width), 0).r);
}
