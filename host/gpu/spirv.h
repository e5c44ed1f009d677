/// The kernels embedded in the program, by name; each target's generated file registers its own.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

namespace vkpm {

struct EmbeddedSpirv {
    std::string_view name;
    std::span<const std::uint32_t> words;
};

/// Registers kernels before main starts.
struct SpirvRegistration {
    SpirvRegistration(std::initializer_list<EmbeddedSpirv> kernels);
};

/// Whether there is a kernel of this name.
bool isKernel(std::string_view name);
/// The SPIR-V words of a kernel; the name must be that of a .comp file, and "/plain" after it for what it is in plain
/// scenes, see WORLD_FEATURES in shared.h.
std::span<const std::uint32_t> findSpirv(std::string_view name);

} // namespace vkpm
