/// Command buffers: push, dispatch, stamp the time, barrier.
#include "gpu/recording.h"
#include "gpu/buffer_handles.h"
#include "gpu/kernel_handles.h"
#include <algorithm>

namespace vkpm {

const std::uint32_t maxStamps = 8192;
const std::uint64_t maxGroupsPerAxis = 65535;

struct Recording::Handles {
    Gpu& gpu;
    vk::raii::CommandBuffer commands{nullptr};
    std::vector<std::string> names; // of the runs between stamps i and i + 1
    bool open = false;

    bool stamps() const { return gpu.timesKernels && gpu.handles->nanosecondsPerTick > 0; }

    // All that ran before is visible to all that runs after.
    void barrier() {
        const vk::MemoryBarrier2 barrier{.srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                         .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
                                         .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                         .dstAccessMask =
                                             vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite};
        commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
    }

    void stamp(std::string name) {
        barrier();
        names.push_back(std::move(name));
        if (stamps())
            commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *gpu.handles->stamps,
                                     static_cast<std::uint32_t>(names.size()));
    }

    void bind(const RawKernel& kernel, const void* args, std::uint32_t bytes) {
        commands.bindPipeline(vk::PipelineBindPoint::eCompute, *kernel.handles->pipeline);
        commands.pushConstants<std::uint8_t>(
            *kernel.handles->layout, vk::ShaderStageFlagBits::eCompute, 0,
            vk::ArrayProxy<const std::uint8_t>(bytes, static_cast<const std::uint8_t*>(args)));
    }
};

Recording::Recording(Gpu& gpu) : handles(std::make_unique<Handles>(Handles{.gpu = gpu})) {}
Recording::~Recording() = default;

void Recording::begin() {
    if (handles->names.size() + 2 >= maxStamps) submit();
    if (handles->open) return;
    const auto& vk = *handles->gpu.handles;
    if (handles->stamps()) vk.stamps.reset(0, maxStamps);
    handles->commands = vk.begin();
    if (handles->stamps()) handles->commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *vk.stamps, 0);
    handles->open = true;
}

void Recording::dispatch(const RawKernel& kernel, std::uint64_t threads, const void* args, std::uint32_t bytes) {
    if (threads == 0) return;
    begin();
    handles->bind(kernel, args, bytes);
    const std::uint64_t groups = (threads + GROUP - 1) / GROUP;
    const std::uint64_t columns = std::min(groups, maxGroupsPerAxis);
    const std::uint64_t rows = (groups + columns - 1) / columns;
    handles->commands.dispatch(static_cast<uint>(columns), static_cast<uint>(rows), 1);
    handles->stamp(kernel.handles->name);
}

void Recording::dispatchIndirect(const RawKernel& kernel, const RawBuffer& queues, std::uint64_t offset,
                                 const void* args, std::uint32_t bytes) {
    begin();
    handles->bind(kernel, args, bytes);
    handles->commands.dispatchIndirect(*queues.handles->buffer, offset);
    handles->stamp(kernel.handles->name);
}

void Recording::clear(const RawBuffer& buffer) {
    if (buffer.bytes == 0) return;
    begin();
    handles->commands.fillBuffer(*buffer.handles->buffer, 0, VK_WHOLE_SIZE, 0);
    handles->stamp("clear");
}

// Time between two stamps belongs to the run between them; a queue without stamps gives no times.
void Recording::addTimes() {
    const auto& vk = *handles->gpu.handles;
    for (const std::string& name : handles->names) handles->gpu.times[name].dispatches++;
    if (!handles->stamps()) return;
    const auto count = static_cast<std::uint32_t>(handles->names.size()) + 1;
    const auto [result, ticks] =
        vk.stamps.getResults<std::uint64_t>(0, count, count * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                            vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
    for (std::uint32_t i = 0; result == vk::Result::eSuccess && i + 1 < count; i++)
        handles->gpu.times[handles->names[i]].seconds +=
            double((ticks[i + 1] - ticks[i]) & vk.tickMask) * vk.nanosecondsPerTick * 1e-9;
}

void Recording::submit() {
    if (!handles->open) return;
    if (handles->gpu.cancel && *handles->gpu.cancel) throw Cancelled{};
    handles->gpu.handles->submitAndWait(handles->commands);
    addTimes();
    handles->names.clear();
    handles->open = false;
}

} // namespace vkpm
