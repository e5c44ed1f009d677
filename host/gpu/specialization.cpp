/// Specialising kernels by SPIRV-Tools.
#include "gpu/specialization.h"
#include "gpu/spirv.h"
#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>
#include <stdexcept>
#include <unordered_map>

namespace vkpm {

/// Adds passes that make constants of features, and remove branches that hang on these alone.
static spvtools::Optimizer& addFeatures(spvtools::Optimizer& optimizer, const Features& features) {
    const std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values{
#define X(id, type, name, value) {id, {features.name}},
        FEATURES(X)
#undef X
    };
    return optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass());
}

static std::vector<std::uint32_t> run(const spvtools::Optimizer& optimizer, std::string_view kernel) {
    const auto words = findSpirv(kernel);
    std::vector<std::uint32_t> optimised;
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);
    if (!optimizer.Run(words.data(), words.size(), &optimised, options))
        throw std::runtime_error(fmt::format("SPIRV-Tools cannot optimise the kernel {}", kernel));
    return optimised;
}

// Functions that are called no longer go, then branches that hang on variables. Inlining would make kernels half as
// large, but takes longer than the driver saves.
std::vector<std::uint32_t> specialized(std::string_view kernel, const Features& features) {
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    addFeatures(optimizer, features)
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    return run(optimizer, kernel);
}

/// Instructions between the first OpFunction and the end.
static std::size_t countInFunctions(const std::vector<std::uint32_t>& words) {
    const std::uint32_t headerWords = 5, opFunction = 54; // SPIR-V specification 1.6, sections 2.3 and 3.42.9
    std::size_t count = 0;
    bool inFunctions = false;
    for (std::size_t i = headerWords; i < words.size(); i += words[i] >> 16) {
        inFunctions |= (words[i] & 0xffff) == opFunction;
        count += inFunctions;
    }
    return count;
}

std::size_t instructionCount(std::string_view kernel, const Features& features) {
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    addFeatures(optimizer, features)
        .RegisterPass(spvtools::CreateMergeReturnPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateSSARewritePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
    return countInFunctions(run(optimizer, kernel));
}

} // namespace vkpm
