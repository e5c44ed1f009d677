/// Compute kernels: a .comp file, specialised for the features of a scene.
#pragma once
#include "gpu/gpu.h"
#include "shared.h"
#include <type_traits>

namespace vkpm {

/// A compiled pipeline; its push constants are `argsBytes` bytes. The same kernel with the same features is compiled
/// once for a device, and shared as long as anyone has it.
class RawKernel {
public:
    RawKernel(Gpu& gpu, std::string name, const Features& features, std::uint32_t argsBytes);

    struct Handles;
    std::shared_ptr<const Handles> handles;
};

/// The kernel of shaders/<name>.comp, whose push constants are an Args.
template <class Args> class Kernel : public RawKernel {
    static_assert(sizeof(Args) <= 128 && std::is_trivially_copyable_v<Args>);

public:
    Kernel(Gpu& gpu, std::string name, const Features& features = {})
        : RawKernel(gpu, std::move(name), features, sizeof(Args)) {}
};

} // namespace vkpm
