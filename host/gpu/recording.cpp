/// Command buffers: push, dispatch, stamp the time, barrier.
#include "gpu/recording.h"
#include "gpu/buffer_handles.h"
#include "gpu/kernel_handles.h"
#include "gpu/recording_part.h"
#include <algorithm>
#include <cstring>
#include <deque>

namespace vkpm {

const std::uint64_t maxGroupsPerAxis = 65535;
const std::size_t partsUnderWay = 2; // one that runs, and one that the device finds when it is done with that

RecordingPart::RecordingPart(const Gpu& gpu) : mailbox(gpu, "mailbox", mailboxBytes) {
    const auto& device = gpu.handles->device;
    commands = std::move(device.allocateCommandBuffers({.commandPool = *gpu.handles->commands,
                                                        .level = vk::CommandBufferLevel::ePrimary,
                                                        .commandBufferCount = 1})[0]);
    fence = device.createFence({});
}

struct Recording::Handles {
    using Part = std::unique_ptr<RecordingPart>;

    Gpu& gpu;
    Part open;                  // what is being recorded
    std::deque<Part> submitted; // the oldest first

    const vk::raii::CommandBuffer& commands() const { return open->commands; }

    // All that ran before is visible to all that runs after.
    void barrier() {
        const vk::MemoryBarrier2 barrier{.srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                         .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
                                         .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                         .dstAccessMask =
                                             vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite};
        commands().pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
    }

    void stamp(std::string name) {
        barrier();
        open->names.push_back(std::move(name));
        if (*open->stamps)
            commands().writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *open->stamps,
                                       static_cast<std::uint32_t>(open->names.size()));
    }

    void bind(const RawKernel& kernel, const void* args, std::uint32_t bytes) {
        commands().bindPipeline(vk::PipelineBindPoint::eCompute, kernel.handles->pipeline());
        commands().pushConstants<std::uint8_t>(
            *kernel.handles->layout, vk::ShaderStageFlagBits::eCompute, 0,
            vk::ArrayProxy<const std::uint8_t>(bytes, static_cast<const std::uint8_t*>(args)));
    }

    // Sends home what the mailbox has for the host; a fence alone does not make it visible there.
    void endPart() {
        const vk::MemoryBarrier2 toHost{.srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                        .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
                                        .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                        .dstAccessMask = vk::AccessFlagBits2::eHostRead};
        commands().pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &toHost});
        commands().end();
    }

    // Time between two stamps belongs to the run between them; a queue without stamps gives no times.
    void addTimes(const RecordingPart& part) {
        for (const std::string& name : part.names) gpu.times[name].dispatches++;
        gpu.dispatches += part.names.size();
        if (!*part.stamps) return;
        const auto count = static_cast<std::uint32_t>(part.names.size()) + 1;
        const auto [result, ticks] =
            part.stamps.getResults<std::uint64_t>(0, count, count * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                                  vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
        for (std::uint32_t i = 0; result == vk::Result::eSuccess && i + 1 < count; i++)
            gpu.times[part.names[i]].seconds +=
                double((ticks[i + 1] - ticks[i]) & gpu.handles->tickMask) * gpu.handles->nanosecondsPerTick * 1e-9;
    }

    void finishOldest() {
        gpu.waits += gpu.handles->wait(submitted.front()->fence); // may throw: what runs keeps what it uses
        Part part = std::move(submitted.front());
        submitted.pop_front();
        addTimes(*part);
        for (const RecordingPart::Letter& letter : part->letters)
            std::memcpy(letter.value, part->mailbox.mapped + letter.offset, letter.bytes);
        gpu.handles->idleParts.push_back(std::move(part));
    }
};

Recording::Recording(Gpu& gpu) : handles(std::make_unique<Handles>(Handles{.gpu = gpu})) {}

Recording::~Recording() {
    try {
        for (const auto& part : handles->submitted) part->letters.clear(); // their readers may be gone
        while (!handles->submitted.empty()) handles->finishOldest();
        if (handles->open) handles->gpu.handles->idleParts.push_back(std::move(handles->open));
    } catch (const std::exception&) {
        handles->gpu.handles->settle();
    }
}

void Recording::begin() {
    if (handles->open && handles->open->names.size() + 2 >= maxStamps) flush();
    if (handles->open) return;
    Gpu& gpu = handles->gpu;
    auto& idle = gpu.handles->idleParts;
    if (idle.empty()) idle.push_back(std::make_unique<RecordingPart>(gpu));
    Handles::Part part = std::move(idle.back());
    idle.pop_back();
    part->names.clear();
    part->letters.clear();
    part->used = 0;
    const bool timed = gpu.timesKernels && gpu.handles->nanosecondsPerTick > 0;
    if (timed != bool(*part->stamps))
        part->stamps =
            timed
                ? gpu.handles->device.createQueryPool({.queryType = vk::QueryType::eTimestamp, .queryCount = maxStamps})
                : vk::raii::QueryPool{nullptr};
    gpu.handles->device.resetFences(*part->fence);
    part->commands.reset();
    part->commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    if (timed) {
        part->commands.resetQueryPool(*part->stamps, 0, maxStamps);
        part->commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *part->stamps, 0);
    }
    handles->open = std::move(part);
}

void Recording::dispatch(const RawKernel& kernel, std::uint64_t threads, const void* args, std::uint32_t bytes) {
    if (threads == 0) return;
    begin();
    handles->bind(kernel, args, bytes);
    const std::uint64_t groups = (threads + GROUP - 1) / GROUP;
    const std::uint64_t columns = std::min(groups, maxGroupsPerAxis);
    const std::uint64_t rows = (groups + columns - 1) / columns;
    handles->commands().dispatch(static_cast<uint>(columns), static_cast<uint>(rows), 1);
    handles->stamp(kernel.handles->name);
}

void Recording::dispatchIndirect(const RawKernel& kernel, const RawBuffer& queues, std::uint64_t offset,
                                 const void* args, std::uint32_t bytes) {
    begin();
    handles->bind(kernel, args, bytes);
    handles->commands().dispatchIndirect(*queues.handles->buffer, offset);
    handles->stamp(kernel.handles->name);
}

void Recording::clear(const RawBuffer& buffer) {
    if (buffer.bytes == 0) return;
    begin();
    handles->commands().fillBuffer(*buffer.handles->buffer, 0, VK_WHOLE_SIZE, 0);
    handles->stamp("clear");
}

void Recording::update(const RawBuffer& buffer, const void* data, std::uint64_t bytes) {
    if (bytes == 0) return;
    begin();
    handles->commands().updateBuffer<std::uint8_t>(
        *buffer.handles->buffer, 0,
        vk::ArrayProxy<const std::uint8_t>(static_cast<std::uint32_t>(bytes), static_cast<const std::uint8_t*>(data)));
    handles->barrier();
}

void Recording::fetch(const RawBuffer& buffer, std::uint64_t offset, void* value, std::uint64_t bytes) {
    if (handles->open && handles->open->used + bytes > mailboxBytes) flush();
    begin();
    RecordingPart& part = *handles->open;
    part.commands.copyBuffer(*buffer.handles->buffer, *part.mailbox.buffer,
                             vk::BufferCopy{.srcOffset = offset, .dstOffset = part.used, .size = bytes});
    handles->barrier();
    part.letters.push_back({part.used, value, bytes});
    part.used += bytes;
}

void Recording::flush() {
    if (!handles->open) return;
    Gpu& gpu = handles->gpu;
    if (gpu.cancel && *gpu.cancel) throw Cancelled{};
    handles->endPart();
    gpu.handles->submit(handles->open->commands, *handles->open->fence);
    handles->submitted.push_back(std::move(handles->open));
    while (handles->submitted.size() > partsUnderWay) handles->finishOldest();
}

void Recording::wait() {
    if (handles->submitted.empty()) return;
    handles->gpu.waits += handles->gpu.handles->wait(handles->submitted.back()->fence); // and so for all
    while (!handles->submitted.empty()) handles->finishOldest();
}

void Recording::submit() {
    flush();
    wait();
}

} // namespace vkpm
