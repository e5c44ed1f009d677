/// The Vulkan handles behind a kernel; included by the sources of host/gpu alone.
#pragma once
#include "gpu/handles.h"
#include "gpu/kernel.h"

namespace vkpm {

struct RawKernel::Handles {
    std::string name;
    vk::raii::PipelineLayout layout{nullptr};
    vk::raii::Pipeline pipeline{nullptr};
};

} // namespace vkpm
