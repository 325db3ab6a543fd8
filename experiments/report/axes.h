// Where an axis begins and ends and what its ticks say, decided here and not by the plotter: so
// that zeros have a place on logarithmic axes and labels fit.
#pragma once

#include <string>
#include <vector>

#include "experiments/report/chapters/chapter.h"

namespace farcull {

struct Tick {
  double at = 0;
  std::string label;  // empty: a minor tick
};

struct Scale {
  bool logarithmic = false;
  double from = 0, to = 1;  // from < to; of a logarithmic one 0 < from
  double zero = 0;          // where zeros are drawn on a logarithmic axis; 0: nowhere
  double linear_to = 0;     // with zeros: the axis is linear from 0 to this value
  std::vector<Tick> ticks;  // ascending, inside the range

  /// Where a value is drawn; NaN where it has no place (0 on a logarithmic axis without zeros).
  double place(double value) const;
  /// How far along the axis a place is: 0 at its beginning, 1 at its end.
  double along(double place) const;
  /// How many characters the longest label has.
  std::size_t label_width() const;
};

/// values: all that are drawn along the axis, NaN and infinities among them; room: how many
/// characters of labels there is room for side by side (of a vertical axis: 8 times the lines).
Scale scale_of(const Axis& axis, const std::vector<double>& values, std::size_t room);

/// 12345.678 as people read it: 12,346; few digits, no zeros at the end; 10^5 where it is long.
std::string tick_label(double value);
/// 10 to an integer power, with superscript digits.
std::string power_label(int exponent);
/// How many characters a UTF-8 text shows.
std::size_t characters(const std::string& text);

}  // namespace farcull
