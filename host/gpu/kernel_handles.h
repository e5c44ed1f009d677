/// The Vulkan handles behind a kernel; included by the sources of host/gpu alone.
#pragma once
#include "gpu/handles.h"
#include "gpu/kernel.h"
#include <future>

namespace vkpm {

struct RawKernel::Handles {
    std::string name;
    vk::raii::PipelineLayout layout{nullptr};
    std::shared_future<vk::raii::Pipeline> created; // by a thread of its own

    bool isReady() const { return created.wait_for(std::chrono::seconds{0}) == std::future_status::ready; }
    /// Waits for it, and throws what its thread threw.
    vk::Pipeline pipeline() const { return *created.get(); }
};

} // namespace vkpm
