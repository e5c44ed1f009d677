/// The Vulkan handles behind Gpu; included by the sources of host/gpu alone.
#pragma once
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include "gpu/kernel.h"
#include <functional>
#include <vulkan/vulkan_raii.hpp>

namespace vkpm {

struct Gpu::Handles {
    vk::raii::Context context;
    vk::raii::Instance instance{nullptr};
    vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
    vk::raii::PhysicalDevice physical{nullptr};
    vk::raii::Device device{nullptr};
    vk::raii::Queue queue{nullptr};
    vk::raii::CommandPool commands{nullptr};
    vk::raii::QueryPool stamps{nullptr};
    std::uint32_t family = 0;
    float nanosecondsPerTick = 0;
    bool mapsDeviceMemory = false; // the host can write device memory directly
    std::uint64_t freeBytes = 0; // of device memory when the device was opened
    DeviceInfo info;
    std::map<std::string, std::weak_ptr<const RawKernel::Handles>> kernels; // by name and features

    /// Submits recorded commands and waits until they are done.
    void submitAndWait(const vk::raii::CommandBuffer& commands) const;
    /// Records commands, submits them and waits until they are done.
    void execute(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;
};

/// Runs a Vulkan call; its failure becomes a GpuError that names the call, the cause and what helps.
template <class Call> auto attempt(const std::string& what, const std::string& help, Call&& call) {
    try {
        return call();
    } catch (const vk::SystemError& error) {
        throw GpuError(what + " failed: " + error.what() + (help.empty() ? "" : "; " + help));
    }
}

} // namespace vkpm
