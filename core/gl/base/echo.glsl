// The echo: a program writes a hash of the values that it reads; core/gl/base/objects.h has the same arithmetic, and the reason for it. far_mixed() mixes a
// word with its place; FAR_ADD adds that to `sum`.
uint far_mixed(uint word, uint place) {
  uint mixed = word ^ place * 0x9e3779b9u;
  mixed = (mixed ^ mixed >> 16) * 0x85ebca6bu;
  mixed = (mixed ^ mixed >> 13) * 0xc2b2ae35u;
  return mixed ^ mixed >> 16;
}
#define FAR_ADD(place, word) sum += far_mixed((word), (place));
