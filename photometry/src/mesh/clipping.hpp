// What sigma clipping does to normal values, whichever way they are kept.
#pragma once

namespace astroid::detail {

/// Clipping that has not settled by then only oscillates by a value or two.
inline constexpr int kMostClippings = 100;

/// What clipping at `clip` sigma of what is left leaves of the scatter of normal values.
[[nodiscard]] double clipped_share(double clip);

/// 2.5 median - 1.5 mean where the two are within 0.3 of the clipped rms, else the median. @source BertinArnouts1996 §7
[[nodiscard]] double mode_from(double median, double mean, double rms);

}  // namespace astroid::detail
