// Lists the members of a struct together with their names. Code that writes, adds or compares all
// members loops over this list. So a new member needs only one new entry in the list.
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>

/// Use inside a struct. Lists the given members as its fields, in this order. Example:
///   struct Sizes { int width = 0, height = 0; FARCULL_FIELDS(width, height) };
/// sizes.fields(visit) then calls visit("width", sizes.width) and visit("height", sizes.height).
#define FARCULL_FIELDS(...)                                                                     \
  static constexpr std::string_view kFieldNames = #__VA_ARGS__;                                 \
  auto members() const { return std::tie(__VA_ARGS__); }                                        \
  auto members() { return std::tie(__VA_ARGS__); }                                              \
  template <class Visit>                                                                        \
  void fields(Visit&& visit) const {                                                            \
    std::string_view rest = kFieldNames;                                                        \
    std::apply(                                                                                 \
        [&](const auto&... member) { (visit(::farcull::take_field_name(rest), member), ...); }, \
        members());                                                                             \
  }

namespace farcull {

/// Removes the first name from the list "a, b, c" and returns it.
constexpr std::string_view take_field_name(std::string_view& names) {
  const std::size_t end = names.find(',');
  const std::string_view name = names.substr(0, end);
  names.remove_prefix(end == std::string_view::npos ? names.size() : end + 1);
  names.remove_prefix(names.starts_with(' ') ? 1 : 0);
  return name;
}

template <class T>
concept HasFields = requires(const T& value) {
  value.fields([](std::string_view, const auto&) {});
};

/// Adds each field of `more` to the same field of `sum`.
template <HasFields T>
void add_fields(const T& more, T& sum) {
  std::apply(
      [&](auto&... to) {
        std::apply([&](const auto&... from) { ((to += from), ...); }, more.members());
      },
      sum.members());
}

}  // namespace farcull
