/// The registry of embedded kernels.
#include "gpu/spirv.h"
#include <map>
#include <stdexcept>
#include <string>

namespace vkpm {

static std::map<std::string_view, std::span<const std::uint32_t>>& registry() {
    static std::map<std::string_view, std::span<const std::uint32_t>> kernels;
    return kernels;
}

SpirvRegistration::SpirvRegistration(std::initializer_list<EmbeddedSpirv> kernels) {
    for (const EmbeddedSpirv& kernel : kernels) registry()[kernel.name] = kernel.words;
}

bool isKernel(std::string_view name) { return registry().contains(name); }

std::span<const std::uint32_t> findSpirv(std::string_view name) {
    const auto found = registry().find(name);
    if (found == registry().end()) throw std::logic_error("no kernel is named " + std::string(name));
    return found->second;
}

} // namespace vkpm
