// Arithmetic on long runs of pixels, on the widest vectors of the processor (vector_target.hpp).
//
// Each kernel has a plain scalar twin in namespace reference, with the same bits. @thread safe, no state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace astroid {

/// Writes the indices of the values at or above the limit, in rising order; a NaN is not.
/// @param found  [out] at least values.size() long.  @returns how many there are.
std::size_t find_at_least(std::span<const double> values, double limit, std::span<std::uint32_t> found);

/// values[i] += constant; values[i] += other[i]; values[i] *= other[i]; out[i] = values[i] * factor.
void add_constant(std::span<double> values, double constant);
void add_values(std::span<double> values, std::span<const float> other);
void multiply_values(std::span<double> values, std::span<const float> other);
void scale_values(std::span<const double> values, double factor, std::span<double> out);

/// out[i] = max(0, base[i] + (weights[0] maps[0][i] + weights[1] maps[1][i] + ...)), the sum in brackets in single
/// precision and in this order, the rest in double. Light is not negative, which a polynomial does not know in the far
/// wings of a saturated star.
/// @param maps  weights.size() pointers to out.size() values each.
void combine_maps(std::span<const double> base, std::span<const float* const> maps, std::span<const float> weights,
                  std::span<double> out);

namespace reference {
void add_constant(std::span<double> values, double constant);
void add_values(std::span<double> values, std::span<const float> other);
void multiply_values(std::span<double> values, std::span<const float> other);
void scale_values(std::span<const double> values, double factor, std::span<double> out);
std::size_t find_at_least(std::span<const double> values, double limit, std::span<std::uint32_t> found);
void combine_maps(std::span<const double> base, std::span<const float* const> maps, std::span<const float> weights,
                  std::span<double> out);
}  // namespace reference

}  // namespace astroid
