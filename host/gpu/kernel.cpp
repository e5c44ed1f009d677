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

static std::shared_ptr<const RawKernel::Handles> compile(const vk::raii::Device& device, const std::string& name, const Features& features, std::uint32_t argsBytes) {
    auto handles = std::make_shared<RawKernel::Handles>();
    handles->name = name;
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
    return handles;
}

RawKernel::RawKernel(Gpu& gpu, std::string name, const Features& features, std::uint32_t argsBytes) {
    std::weak_ptr<const Handles>& known = gpu.handles->kernels[name + std::string(reinterpret_cast<const char*>(&features), sizeof(features))];
    handles = known.lock();
    if (!handles) known = handles = compile(gpu.handles->device, name, features, argsBytes);
}

} // namespace vkpm
