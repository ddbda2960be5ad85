// Which vector instructions the kernels use: chosen when the program starts, changed only to test or to compare.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace astroid {

/// Instruction sets that this processor has and the kernels were built for, the widest first: "AVX3" (AVX-512), "AVX2",
/// "SSE4", "SSSE3". Results are the same bits on each (docs/decisions/0002-determinism.md).
std::vector<std::string> vector_targets();

/// The one in use.
std::string vector_target();

/// Makes every kernel use this one from now on; an empty name goes back to the widest. Not while kernels run.
/// @throws InputError for a name that is not among vector_targets().
void force_vector_target(std::string_view name);

}  // namespace astroid
