/// Pipelines: one shader stage, push constants, specialization constants, nothing else.
#include "gpu/kernel_handles.h"
#include "gpu/specialization.h"
#include "gpu/spirv.h"
#include "shared_kinds.h"
#include <algorithm>
#include <array>
#include <semaphore>
#include <thread>

namespace vkpm {

const std::size_t keptKernels = 64; // after their last renderer; about a megabyte each on lavapipe

static const std::array featureIds{
#define X(id, type, name, value) std::uint32_t(id),
    FEATURES(X)
#undef X
};
using FeatureWords = std::array<std::uint32_t, featureIds.size()>;

static FeatureWords wordsOf(const Features& features) {
    return {
#define X(id, type, name, value) features.name,
        FEATURES(X)
#undef X
    };
}

// The kernel's name, or that of its plain form if that has all that is needed.
static std::string embeddedName(const std::string& name, const Features& f) {
    bool plain = (f.materialKinds & GLOSSY_KINDS) == 0 && (f.lightKinds & ~AREA_KINDS) == 0;
#define X(id, type, feature, value) plain = plain && !f.feature;
    WORLD_FEATURES(X)
#undef X
    return plain && isKernel(name + "/plain") ? name + "/plain" : name;
}

static vk::raii::Pipeline createPipeline(const vk::raii::Device& device, const std::string& name,
                                         const std::string& embedded, const Features& has, vk::PipelineLayout layout) {
    const FeatureWords features = wordsOf(has);
    // Plain kernels are small as they are.
    const bool isSpecial = embedded == name && features != wordsOf(Features{});
    const std::vector<std::uint32_t> special = isSpecial ? specialized(name, has) : std::vector<std::uint32_t>{};
    const auto words = isSpecial ? std::span(special) : findSpirv(embedded);
    std::array<vk::SpecializationMapEntry, featureIds.size()> entries;
    for (std::uint32_t i = 0; i < entries.size(); i++)
        entries[i] = vk::SpecializationMapEntry{.constantID = featureIds[i], .offset = 4 * i, .size = 4};
    return attempt("creating the kernel " + name, "", [&] {
        const vk::raii::ShaderModule module(
            device, vk::ShaderModuleCreateInfo{.codeSize = words.size_bytes(), .pCode = words.data()});
        const vk::SpecializationInfo constants{.mapEntryCount = entries.size(),
                                               .pMapEntries = entries.data(),
                                               .dataSize = sizeof(features),
                                               .pData = features.data()};
        const vk::PipelineShaderStageCreateInfo stage{.stage = vk::ShaderStageFlagBits::eCompute,
                                                      .module = *module,
                                                      .pName = "main",
                                                      .pSpecializationInfo = &constants};
        return device.createComputePipeline(nullptr, vk::ComputePipelineCreateInfo{.stage = stage, .layout = layout});
    });
}

// Drivers take their time for a pipeline: as many are created at a time as there are cores, while the host goes on.
// Where the system gives no thread, a pipeline is created when it is asked for.
static std::shared_ptr<const RawKernel::Handles> create(const vk::raii::Device& device, const std::string& name,
                                                        const std::string& embedded, const Features& features,
                                                        std::uint32_t argsBytes) {
    static std::counting_semaphore<> cores{std::max<std::ptrdiff_t>(std::thread::hardware_concurrency(), 1)};
    auto handles = std::make_shared<RawKernel::Handles>();
    handles->name = name;
    const vk::PushConstantRange range{.stageFlags = vk::ShaderStageFlagBits::eCompute, .size = argsBytes};
    attempt("creating the kernel " + name, "", [&] {
        handles->layout = device.createPipelineLayout({.pushConstantRangeCount = 1, .pPushConstantRanges = &range});
    });
    handles->created = std::async(std::launch::async | std::launch::deferred, [&device, name, embedded, features,
                                                                               layout = *handles->layout] {
                           cores.acquire();
                           const std::shared_ptr<void> done(nullptr, [](void*) { cores.release(); });
                           return createPipeline(device, name, embedded, features, layout);
                       }).share();
    // The validation layer numbers what it writes into kernels: one after the other, or the driver's cache knows none.
    if (wantsValidation()) handles->created.wait();
    return handles;
}

// A dispatch of nothing: drivers that compile a kernel when it first runs do so while the host goes on.
static void warmUp(Gpu::Handles& gpu, const std::shared_ptr<const RawKernel::Handles>& kernel,
                   std::uint32_t argsBytes) {
    vk::raii::CommandBuffer commands = gpu.begin();
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, kernel->pipeline());
    commands.pushConstants<std::uint8_t>(*kernel->layout, vk::ShaderStageFlagBits::eCompute, 0,
                                         std::vector<std::uint8_t>(argsBytes));
    commands.dispatch(0, 1, 1);
    commands.end();
    gpu.submit(commands, nullptr);
    gpu.warmingUp.emplace_back(std::move(commands), kernel);
}

static void warmUpCreated(Gpu::Handles& gpu) {
    std::erase_if(gpu.toWarmUp, [&](const Gpu::Handles::ToWarmUp& waiting) {
        if (!waiting.kernel->isReady()) return false;
        warmUp(gpu, waiting.kernel, waiting.argsBytes);
        return true;
    });
}

RawKernel::RawKernel(Gpu& gpu, std::string name, const Features& features, std::uint32_t argsBytes) {
    const FeatureWords words = wordsOf(features);
    const std::string embedded = embeddedName(name, features);
    const std::string featureBytes(reinterpret_cast<const char*>(words.data()), sizeof(words));
    std::weak_ptr<const Handles>& known = gpu.handles->kernels[{findSpirv(embedded).data(), featureBytes}];
    handles = known.lock();
    if (handles) return;
    known = handles = create(gpu.handles->device, name, embedded, features, argsBytes);
    if (gpu.compilesAhead) gpu.handles->toWarmUp.push_back({handles, argsBytes});
    warmUpCreated(*gpu.handles);
    gpu.handles->recent.push_back(handles);
    if (gpu.handles->recent.size() > keptKernels) gpu.handles->recent.pop_front();
}

} // namespace vkpm
