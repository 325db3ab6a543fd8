// The active triangles as they were sent, and their bounds.
layout(std430, binding = 0) buffer Vertices { uvec4 tag_0; readonly vec4 vertices[]; };
#define FAR_TAG_0 tag_0.x
layout(std430, binding = 1) buffer Triangles { uvec4 tag_1; readonly uint triangles[]; };  // three vertices each
#define FAR_TAG_1 tag_1.x
layout(std430, binding = 2) buffer Owners { uvec4 tag_2; readonly uint owners[]; };        // object of each triangle
#define FAR_TAG_2 tag_2.x
layout(std430, binding = 3) buffer Active { uvec4 tag_3; readonly uint active_ones[]; };   // triangles
#define FAR_TAG_3 tag_3.x
// Eight words an object: bits of its limits lo.xyz and hi.xyz, its number << 3 | kSelf, -.
layout(std430, binding = 4) buffer Objects { uvec4 tag_4; readonly uint objects[]; };
#define FAR_TAG_4 tag_4.x

// u_extra.x: position of the first active triangle that was sent. u_extra.y: not 0 where triangles and owners are those of the
// active ones, in their order.

struct FarTriangle {
  vec4 a;
  vec4 b;
  vec4 c;
  vec4 lo;
  vec4 hi;
  vec4 margin;
  uint triangle;
  uint code;
};

// The triangle at a position among those that were sent; false: nothing of it is within the limits of its owner.
bool far_triangle(uint w, out FarTriangle t) {
  t.triangle = FAR_AT(active_ones, w);
  uint at = u_extra.y != 0u ? w : t.triangle;
  t.a = vec4(FAR_AT(vertices, FAR_AT(triangles, 3u * at)).xyz, 0.0f);
  t.b = vec4(FAR_AT(vertices, FAR_AT(triangles, 3u * at + 1u)).xyz, 0.0f);
  t.c = vec4(FAR_AT(vertices, FAR_AT(triangles, 3u * at + 2u)).xyz, 0.0f);
  far_bounds(t.a, t.b, t.c, u_widen, t.lo, t.hi);
  t.margin = far_margin(t.lo, t.hi, u_widen);
  uint object = 8u * FAR_AT(owners, at);
  t.lo.xyz = max(t.lo.xyz, vec3(uintBitsToFloat(FAR_AT(objects, object)), uintBitsToFloat(FAR_AT(objects, object + 1u)),
                                uintBitsToFloat(FAR_AT(objects, object + 2u))));
  t.hi.xyz = min(t.hi.xyz, vec3(uintBitsToFloat(FAR_AT(objects, object + 3u)), uintBitsToFloat(FAR_AT(objects, object + 4u)),
                                uintBitsToFloat(FAR_AT(objects, object + 5u))));
  t.code = FAR_AT(objects, object + 6u);
  return t.lo.x <= t.hi.x && t.lo.y <= t.hi.y && t.lo.z <= t.hi.z;
}
