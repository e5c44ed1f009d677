/// Memory of the host that the device copies from and to; included by the sources of host/gpu alone.
#pragma once
#include "gpu/handles.h"

namespace vkpm {

/// A buffer that stays mapped; cached by the host if the device has such memory, since it is read.
struct HostMemory {
    HostMemory() = default;
    HostMemory(const Gpu& gpu, const std::string& name, std::uint64_t bytes);

    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Buffer buffer{nullptr}; // destroyed before its memory
    char* mapped = nullptr;
    std::uint64_t bytes = 0;
};

} // namespace vkpm
