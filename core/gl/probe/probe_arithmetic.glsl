// The operations that kernels use, on given operands. Results are stored as bits, unchanged.
layout(std430, binding = 2) readonly buffer Operands { vec4 operands[]; };  // a, b, c, -
layout(std430, binding = 3) writeonly buffer Results { uvec4 results[]; };  // three for each case

void probe_case(uint i) {
  float a = operands[i].x;
  float b = operands[i].y;
  float c = operands[i].z;
  FAR_PRECISE float sum = a + b;
  FAR_PRECISE float difference = a - b;
  FAR_PRECISE float product = a * b;
  FAR_PRECISE float quotient = a / b;
  FAR_PRECISE float chain = difference + b;    // would be a if simplified
  FAR_PRECISE float remainder = product - c;   // would be the product's rounding error if fused
  float least = min(a, b);
  float most = max(a, b);
  float size = abs(a);
  uint order = (a < b ? 1u : 0u) | (a <= b ? 2u : 0u) | (a > b ? 4u : 0u) | (a >= b ? 8u : 0u) |
               (a == b ? 16u : 0u) | (a != b ? 32u : 0u);
  results[3u * i] = floatBitsToUint(vec4(sum, difference, product, quotient));
  results[3u * i + 1u] = floatBitsToUint(vec4(chain, remainder, least, most));
  results[3u * i + 2u] = uvec4(floatBitsToUint(size), order, floatBitsToUint(a), floatBitsToUint(c));
}

uniform uint u_width;  // of the target, px

void main() {
  uvec2 pixel = uvec2(floor(gl_FragCoord.xy));
  probe_case(pixel.y * u_width + pixel.x);
}
