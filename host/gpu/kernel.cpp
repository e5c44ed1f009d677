/// Pipelines: one shader stage, push constants, specialization constants, nothing else.
#include "gpu/kernel_handles.h"
#include "gpu/spirv.h"
#include <array>

namespace vkpm {

// The fields of Features are all uint, in the order of FEATURES.
static const std::array featureEntries{
#define X(id, name, value) vk::SpecializationMapEntry{.constantID = id, .offset = offsetof(Features, name), .size = sizeof(uint)},
    FEATURES(X)
#undef X
};

RawKernel::RawKernel(Gpu& gpu, std::string name, const Features& features, std::uint32_t argsBytes) : handles(std::make_unique<Handles>()) {
    const auto& device = gpu.handles->device;
    const auto words = findSpirv(name);
    attempt("creating the kernel " + name, "", [&] {
        const vk::raii::ShaderModule module(device, vk::ShaderModuleCreateInfo{.codeSize = words.size_bytes(), .pCode = words.data()});
        const vk::PushConstantRange range{.stageFlags = vk::ShaderStageFlagBits::eCompute, .size = argsBytes};
        handles->layout = device.createPipelineLayout({.pushConstantRangeCount = 1, .pPushConstantRanges = &range});
        const vk::SpecializationInfo constants{.mapEntryCount = featureEntries.size(), .pMapEntries = featureEntries.data(),
                                               .dataSize = sizeof(Features), .pData = &features};
        const vk::PipelineShaderStageCreateInfo stage{.stage = vk::ShaderStageFlagBits::eCompute, .module = *module,
                                                      .pName = "main", .pSpecializationInfo = &constants};
        handles->pipeline = device.createComputePipeline(nullptr, vk::ComputePipelineCreateInfo{.stage = stage, .layout = *handles->layout});
    });
    handles->name = std::move(name);
}

RawKernel::RawKernel(RawKernel&&) noexcept = default;
RawKernel::~RawKernel() = default;

} // namespace vkpm
