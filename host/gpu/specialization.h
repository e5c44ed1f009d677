/// Kernels for what a scene needs, by SPIRV-Tools.
#pragma once
#include "shared.h"
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace vkpm {

/// The SPIR-V words of a kernel whose features are constants, without what these make unreachable. Drivers do the same,
/// but read and inline all of it before. Throws std::runtime_error if the optimiser of SPIRV-Tools fails.
std::vector<std::uint32_t> specialized(std::string_view kernel, const Features& features);

/// SPIR-V instructions of a specialised kernel, its functions inlined. Throws like `specialized`.
std::size_t instructionCount(std::string_view kernel, const Features& features);

} // namespace vkpm
