/// What to say when a render does not fit into the device's memory.
#pragma once
#include "gpu/gpu.h"
#include "scene/scene.h"

namespace vkpm {

/// Device memory of the film's runs of passes beyond the first, at the most.
std::uint64_t bytesOfFurtherRuns(const Features& features, const Settings& settings);

/// The most photons per pass, and the caustic map's, with which a render of these settings fits into the memory that is
/// free now, in words: found by what two small passes take and what the device has left.
std::string memoryAdvice(Gpu& gpu, const Scene& scene, const Settings& settings);

/// Returns what `work` does; if the device runs out of memory, throws OutOfMemory with advice. What `work` made is gone
/// by then.
template <class Work> auto adviseOnMemory(Gpu& gpu, const Scene& scene, const Settings& settings, Work&& work) {
    std::string cause;
    try {
        return work();
    } catch (const OutOfMemory& failure) {
        cause = failure.what();
    }
    throw OutOfMemory(cause + "; " + memoryAdvice(gpu, scene, settings));
}

} // namespace vkpm
