// Slices of a pixel that two owners touch: they differ in some bit of their numbers, so one of them touches the region of that
// bit's 0 and the other that of its 1.
layout(std430, binding = 2) buffer Masks { uvec4 tag_2; uint masks[]; };  // as in pair_lists.comp
#define FAR_TAG_2 tag_2.x

// u_extra.x: bits of an owner's number.

void work(uint w) {
  uint conflict = FAR_AT(masks, w);
  for (uint k = 0u; k < u_extra.x; ++k) {
    uint zero = (1u + 2u * k) * 2u * u_cells + w;
    conflict |= FAR_AT(masks, zero) & FAR_AT(masks, zero + 2u * u_cells);
  }
  FAR_AT(masks, w) = conflict;
}
