/// A frame of the window: picture, ImGui, present.
#include "window/presenter_handles.h"
#include <backends/imgui_impl_vulkan.h>
#include <cstring>

namespace vkpm {

const std::uint64_t patience = 20'000'000; // nanoseconds that a frame may wait for the display
const vk::ImageSubresourceRange allOfIt{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1};
const vk::ImageSubresourceLayers color{vk::ImageAspectFlagBits::eColor, 0, 0, 1};

using Layout = vk::ImageLayout;

/// All that was done to an image before is visible to all that follows, in another layout.
static void change(const vk::raii::CommandBuffer& commands, vk::Image image, Layout from, Layout to) {
    const vk::ImageMemoryBarrier2 barrier{.srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                          .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
                                          .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
                                          .dstAccessMask =
                                              vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite,
                                          .oldLayout = from,
                                          .newLayout = to,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = image,
                                          .subresourceRange = allOfIt};
    commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

Presenter::Presenter(GLFWwindow* window) : handles(std::make_unique<Handles>(window)) {}
Presenter::~Presenter() = default;

void Presenter::setPicture(uvec2 size, std::span<const uint> rgba8) {
    (void)handles->device.waitForFences(*handles->finished, true, UINT64_MAX);
    if (handles->picture.size != size) handles->makePicture(size);
    std::memcpy(handles->picture.mapped, rgba8.data(), rgba8.size_bytes());
    handles->picture.changed = true;
}

void Presenter::beginFrame() { ImGui_ImplVulkan_NewFrame(); }

void Presenter::Handles::showPicture(vk::Image target, const Rectangle& where) {
    if (picture.changed) {
        change(commands, *picture.image, Layout::eUndefined, Layout::eTransferDstOptimal);
        commands.copyBufferToImage(
            *picture.staging, *picture.image, Layout::eTransferDstOptimal,
            vk::BufferImageCopy{.imageSubresource = color, .imageExtent = {picture.size.x, picture.size.y, 1}});
        change(commands, *picture.image, Layout::eTransferDstOptimal, Layout::eTransferSrcOptimal);
        picture.changed = false;
    }
    const auto at = [](ivec2 p, int z) { return vk::Offset3D{p.x, p.y, z}; };
    const vk::ImageBlit blit{.srcSubresource = color,
                             .srcOffsets = {{at(ivec2(0), 0), at(ivec2(picture.size), 1)}},
                             .dstSubresource = color,
                             .dstOffsets = {{at(where.corner, 0), at(where.corner + where.size, 1)}}};
    const bool same = where.size == ivec2(picture.size);
    commands.blitImage(*picture.image, Layout::eTransferSrcOptimal, target, Layout::eTransferDstOptimal, blit,
                       same ? vk::Filter::eNearest : vk::Filter::eLinear);
}

void Presenter::Handles::record(std::uint32_t index, const Rectangle& where) {
    const vk::Image target = swapchain.images[index];
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    change(commands, target, Layout::eUndefined, Layout::eTransferDstOptimal);
    commands.clearColorImage(target, Layout::eTransferDstOptimal,
                             vk::ClearColorValue{std::array{0.09f, 0.09f, 0.10f, 1.0f}}, allOfIt);
    const bool inside = where.size.x > 0 && where.size.y > 0 && where.corner.x >= 0 && where.corner.y >= 0 &&
                        where.corner.x + where.size.x <= int(swapchain.extent.width) &&
                        where.corner.y + where.size.y <= int(swapchain.extent.height);
    if (picture.size.x > 0 && inside) {
        change(commands, target, Layout::eTransferDstOptimal, Layout::eTransferDstOptimal);
        showPicture(target, where);
    }
    change(commands, target, Layout::eTransferDstOptimal, Layout::eColorAttachmentOptimal);

    const vk::Rect2D area{.extent = swapchain.extent};
    commands.beginRenderPass(
        {.renderPass = *renderPass, .framebuffer = *swapchain.framebuffers[index], .renderArea = area},
        vk::SubpassContents::eInline);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *commands);
    commands.endRenderPass();
    change(commands, target, Layout::eColorAttachmentOptimal, Layout::ePresentSrcKHR);
    commands.end();
}

void Presenter::Handles::submit(std::uint32_t image) {
    const vk::SemaphoreSubmitInfo wait{.semaphore = *acquired, .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
    const vk::SemaphoreSubmitInfo signal{.semaphore = *swapchain.drawn[image],
                                         .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
    const vk::CommandBufferSubmitInfo buffer{.commandBuffer = *commands};
    device.resetFences(*finished);
    queue.submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = 1,
                                  .pWaitSemaphoreInfos = &wait,
                                  .commandBufferInfoCount = 1,
                                  .pCommandBufferInfos = &buffer,
                                  .signalSemaphoreInfoCount = 1,
                                  .pSignalSemaphoreInfos = &signal},
                  *finished);
}

bool Presenter::Handles::present(std::uint32_t image) {
    const vk::Semaphore drawn = *swapchain.drawn[image];
    const vk::SwapchainKHR shown = *swapchain.handle;
    outOfDate = queue.presentKHR({.waitSemaphoreCount = 1,
                                  .pWaitSemaphores = &drawn,
                                  .swapchainCount = 1,
                                  .pSwapchains = &shown,
                                  .pImageIndices = &image}) == vk::Result::eSuboptimalKHR;
    return true;
}

bool Presenter::draw(const Rectangle& where) {
    Handles& vk = *handles;
    try {
        if (vk.outOfDate && !vk.buildSwapchain()) return false;
        if (vk.device.waitForFences(*vk.finished, true, patience) != vk::Result::eSuccess) return false;
        const auto [result, image] = vk.swapchain.handle.acquireNextImage(patience, *vk.acquired);
        if (result != vk::Result::eSuccess && result != vk::Result::eSuboptimalKHR) return false;
        vk.record(image, where);
        vk.submit(image);
        return vk.present(image);
    } catch (const vk::OutOfDateKHRError&) {
        vk.outOfDate = true;
        return false;
    }
}

} // namespace vkpm
