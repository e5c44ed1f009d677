/// How large a kernel is once its features are known.
#pragma once
#include "shared.h"
#include <cstddef>
#include <string_view>

namespace vkpm {

/// SPIR-V instructions of a kernel, its functions inlined, after its constants are set and what they make unreachable
/// is removed. A driver's compiler goes on from there. Throws std::runtime_error if the optimiser of SPIRV-Tools fails.
std::size_t instructionCount(std::string_view kernel, const Features& features);

} // namespace vkpm
