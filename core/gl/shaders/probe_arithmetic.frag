// probe_case (before this text) once per fragment.
uniform uint u_width;  // of the target, px

void main() {
  uvec2 pixel = uvec2(floor(gl_FragCoord.xy));
  probe_case(pixel.y * u_width + pixel.x);
}
