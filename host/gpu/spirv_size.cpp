/// Specialising kernels by SPIRV-Tools, in order to count.
#include "gpu/spirv_size.h"
#include "gpu/spirv.h"
#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>
#include <stdexcept>
#include <unordered_map>

namespace vkpm {

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
    const std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values{
#define X(id, type, name, value) {id, {features.name}},
        FEATURES(X)
#undef X
    };
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateMergeReturnPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateSSARewritePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
    const auto words = findSpirv(kernel);
    std::vector<std::uint32_t> optimised;
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);
    if (!optimizer.Run(words.data(), words.size(), &optimised, options))
        throw std::runtime_error(fmt::format("SPIRV-Tools cannot optimise the kernel {}", kernel));
    return countInFunctions(optimised);
}

} // namespace vkpm
