// probe_case (before this text) once per invocation.
layout(local_size_x = 64) in;

void main() { probe_case(gl_GlobalInvocationID.x); }
