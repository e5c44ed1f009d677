/// The window's device and swapchain, and a frame of the window: picture, ImGui, present.
#include "window/presenter.h"
#include <GLFW/glfw3.h>
#include <algorithm>
#include <backends/imgui_impl_vulkan.h>
#include <cstring>

namespace vkpm {
namespace {

using Layout = vk::ImageLayout;
using vk::PipelineStageFlagBits::eAllCommands;

const std::uint64_t patience = 20'000'000; // nanoseconds that a frame may wait for the display
const vk::ImageSubresourceRange allOfIt{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1};
const vk::ImageSubresourceLayers color{vk::ImageAspectFlagBits::eColor, 0, 0, 1};

std::span<const char* const> surfaceExtensions() {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (!names) throw GpuError(std::string("no Vulkan driver can draw in a window of this display; ") + installHint);
    return {names, count};
}

int rankOf(const vk::raii::PhysicalDevice& device) {
    const vk::PhysicalDeviceType type = device.getProperties().deviceType;
    if (type == vk::PhysicalDeviceType::eDiscreteGpu) return 0;
    if (type == vk::PhysicalDeviceType::eIntegratedGpu) return 1;
    return type == vk::PhysicalDeviceType::eCpu ? 3 : 2;
}

/// The first queue family that draws and shows; -1 if there is none.
int showingFamily(const vk::raii::PhysicalDevice& device, const vk::raii::SurfaceKHR& surface) {
    const auto families = device.getQueueFamilyProperties();
    for (std::uint32_t i = 0; i < families.size(); i++)
        if ((families[i].queueFlags & vk::QueueFlagBits::eGraphics) && device.getSurfaceSupportKHR(i, *surface))
            return static_cast<int>(i);
    return -1;
}

bool hasSwapchains(const vk::raii::PhysicalDevice& device) {
    return std::ranges::any_of(device.enumerateDeviceExtensionProperties(), [](const auto& extension) {
        return std::string_view(extension.extensionName.data()) == VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    });
}

/// Makes all that was done to an image before visible to all that follows, in another layout.
void change(const vk::raii::CommandBuffer& commands, vk::Image image, Layout from, Layout to) {
    const vk::ImageMemoryBarrier barrier{.srcAccessMask = vk::AccessFlagBits::eMemoryWrite,
                                         .dstAccessMask =
                                             vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite,
                                         .oldLayout = from,
                                         .newLayout = to,
                                         .image = image,
                                         .subresourceRange = allOfIt};
    commands.pipelineBarrier(eAllCommands, eAllCommands, {}, {}, {}, barrier);
}

} // namespace

Presenter::Presenter(GLFWwindow* shown) : window(shown), instance(surfaceExtensions()) {
    VkSurfaceKHR created{};
    const VkResult result = glfwCreateWindowSurface(*instance.handle, window, nullptr, &created);
    if (result != VK_SUCCESS)
        throw GpuError("glfwCreateWindowSurface returned " + vk::to_string(vk::Result(result)) + "; " + installHint);
    surface = vk::raii::SurfaceKHR(instance.handle, created);
    attempt("opening a device for the window", installHint, [&] {
        chooseDevice();
        createDevice();
        createRenderPass();
        startImGui();
    });
}

Presenter::~Presenter() {
    if (*device) vkDeviceWaitIdle(*device); // a lost device is idle, too
    if (imGuiRuns) ImGui_ImplVulkan_Shutdown();
}

void Presenter::chooseDevice() {
    auto devices = instance.handle.enumeratePhysicalDevices();
    std::erase_if(devices, [&](const auto& d) {
        return !hasSwapchains(d) || showingFamily(d, surface) < 0 || d.getProperties().apiVersion < VK_API_VERSION_1_3;
    });
    if (devices.empty())
        throw GpuError(std::string("no Vulkan 1.3 device can show a window on this display; ") + installHint);
    physical = std::move(*std::ranges::min_element(devices, {}, rankOf));
    family = static_cast<std::uint32_t>(showingFamily(physical, surface));

    // Pixels come encoded in sRGB, so that the format is to leave them as they are.
    const VkFormat plain[]{VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM};
    format = ImGui_ImplVulkanH_SelectSurfaceFormat(*physical, *surface, plain, 2, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR);
}

void Presenter::createDevice() {
    const float priority = 1;
    const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    const vk::DeviceQueueCreateInfo queues{.queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    device =
        physical.createDevice(vk::DeviceCreateInfo{}.setQueueCreateInfos(queues).setPEnabledExtensionNames(extension));
    queue = device.getQueue(family, 0);
    pool = device.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = family});
    commands = std::move(device.allocateCommandBuffers(
        {.commandPool = *pool, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1})[0]);
    finished = device.createFence({.flags = vk::FenceCreateFlagBits::eSignaled});
    acquired = device.createSemaphore({});
}

/// ImGui's draws go over what the commands before have put there.
void Presenter::createRenderPass() {
    const vk::AttachmentDescription attachment{.format = format.format,
                                               .loadOp = vk::AttachmentLoadOp::eLoad,
                                               .stencilLoadOp = vk::AttachmentLoadOp::eDontCare,
                                               .stencilStoreOp = vk::AttachmentStoreOp::eDontCare,
                                               .initialLayout = Layout::eColorAttachmentOptimal,
                                               .finalLayout = Layout::eColorAttachmentOptimal};
    const vk::AttachmentReference reference{.attachment = 0, .layout = Layout::eColorAttachmentOptimal};
    const auto subpass = vk::SubpassDescription{}.setColorAttachments(reference);
    renderPass = device.createRenderPass(vk::RenderPassCreateInfo{}.setAttachments(attachment).setSubpasses(subpass));
}

void Presenter::startImGui() {
    const vk::DescriptorPoolSize size{.type = vk::DescriptorType::eCombinedImageSampler, .descriptorCount = 1};
    const vk::DescriptorPoolCreateInfo sets{.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                            .maxSets = 1};
    descriptors = device.createDescriptorPool(vk::DescriptorPoolCreateInfo(sets).setPoolSizes(size));
    ImGui_ImplVulkan_InitInfo info{.Instance = *instance.handle,
                                   .PhysicalDevice = *physical,
                                   .Device = *device,
                                   .QueueFamily = family,
                                   .Queue = *queue,
                                   .DescriptorPool = *descriptors,
                                   .MinImageCount = 2,
                                   .ImageCount = 2,
                                   .MSAASamples = VK_SAMPLE_COUNT_1_BIT};
    info.CheckVkResultFn = [](VkResult result) {
        if (result == VK_ERROR_DEVICE_LOST) throw vk::DeviceLostError("ImGui");
        if (result < 0) throw GpuError("ImGui's Vulkan call returned " + vk::to_string(vk::Result(result)));
    };
    ImGui_ImplVulkan_Init(&info, *renderPass);
    imGuiRuns = true;

#if IMGUI_VERSION_NUM >= 19000
    ImGui_ImplVulkan_CreateFontsTexture();
#else // it only records
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    ImGui_ImplVulkan_CreateFontsTexture(*commands);
    commands.end();
    queue.submit(vk::SubmitInfo{}.setCommandBuffers(*commands));
    queue.waitIdle();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

/// False if the window has no pixels.
bool Presenter::buildSwapchain() {
    device.waitIdle();
    const auto can = physical.getSurfaceCapabilitiesKHR(*surface);
    extent = can.currentExtent;
    if (extent.width == UINT32_MAX) { // the swapchain decides
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        extent.width = std::clamp(std::uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width);
        extent.height = std::clamp(std::uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height);
    }
    if (extent.width == 0 || extent.height == 0) return false;

    // The newest picture, without waiting for the display if it can be had.
    const VkPresentModeKHR modes[]{VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR};
    const VkPresentModeKHR mode = ImGui_ImplVulkanH_SelectPresentMode(*physical, *surface, modes, 2);
    const vk::raii::SwapchainKHR old = std::move(swapchain);
    targets.clear();
    swapchain = device.createSwapchainKHR(
        {.surface = *surface,
         .minImageCount = std::min(can.minImageCount + 1, can.maxImageCount ? can.maxImageCount : UINT32_MAX),
         .imageFormat = format.format,
         .imageColorSpace = format.colorSpace,
         .imageExtent = extent,
         .imageArrayLayers = 1,
         .imageUsage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferDst,
         .preTransform = can.currentTransform,
         .compositeAlpha = vk::CompositeAlphaFlagBitsKHR::eOpaque,
         .presentMode = vk::PresentModeKHR(mode),
         .clipped = true,
         .oldSwapchain = *old});
    for (const VkImage image : swapchain.getImages()) {
        vk::raii::ImageView view = device.createImageView(
            {.image = image, .viewType = vk::ImageViewType::e2D, .format = format.format, .subresourceRange = allOfIt});
        const vk::FramebufferCreateInfo whole{
            .renderPass = *renderPass, .width = extent.width, .height = extent.height, .layers = 1};
        vk::raii::Framebuffer framebuffer =
            device.createFramebuffer(vk::FramebufferCreateInfo(whole).setAttachments(*view));
        targets.push_back({image, std::move(view), std::move(framebuffer), device.createSemaphore({})});
    }
    outOfDate = false;
    return true;
}

vk::raii::DeviceMemory Presenter::allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const {
    const auto memory = physical.getMemoryProperties();
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; i++)
        if ((needs.memoryTypeBits >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted)
            return device.allocateMemory({.allocationSize = needs.size, .memoryTypeIndex = i});
    throw GpuError("no memory type of the device fits the window's picture");
}

void Presenter::makePicture(uvec2 size) {
    PictureImage next{.size = size};
    next.image =
        device.createImage({.imageType = vk::ImageType::e2D,
                            .format = vk::Format::eR8G8B8A8Unorm,
                            .extent = {size.x, size.y, 1},
                            .mipLevels = 1,
                            .arrayLayers = 1,
                            .usage = vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst});
    next.memory = allocate(next.image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
    next.image.bindMemory(*next.memory, 0);
    next.staging = device.createBuffer(
        {.size = std::uint64_t(size.x) * size.y * sizeof(uint), .usage = vk::BufferUsageFlagBits::eTransferSrc});
    next.stagingMemory = allocate(next.staging.getMemoryRequirements(),
                                  vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    next.staging.bindMemory(*next.stagingMemory, 0);
    next.mapped = next.stagingMemory.mapMemory(0, VK_WHOLE_SIZE);
    picture = std::move(next);
}

void Presenter::setPicture(uvec2 size, std::span<const uint> rgba8) {
    (void)device.waitForFences(*finished, true, UINT64_MAX);
    if (picture.size != size) makePicture(size);
    std::memcpy(picture.mapped, rgba8.data(), rgba8.size_bytes());
    picture.changed = true;
}

void Presenter::showPicture(vk::Image target, const Rectangle& where) {
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

void Presenter::record(const Target& target, const Rectangle& where) {
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    change(commands, target.image, Layout::eUndefined, Layout::eTransferDstOptimal);
    commands.clearColorImage(target.image, Layout::eTransferDstOptimal,
                             vk::ClearColorValue{std::array{0.09f, 0.09f, 0.10f, 1.0f}}, allOfIt);
    const ivec2 end = where.corner + where.size, all(extent.width, extent.height);
    const bool inside = where.size.x > 0 && where.size.y > 0 &&
                        glm::all(glm::greaterThanEqual(where.corner, ivec2(0))) &&
                        glm::all(glm::lessThanEqual(end, all));
    if (picture.size.x > 0 && inside) {
        change(commands, target.image, Layout::eTransferDstOptimal, Layout::eTransferDstOptimal);
        showPicture(target.image, where);
    }
    change(commands, target.image, Layout::eTransferDstOptimal, Layout::eColorAttachmentOptimal);
    commands.beginRenderPass(
        {.renderPass = *renderPass, .framebuffer = *target.framebuffer, .renderArea = {.extent = extent}},
        vk::SubpassContents::eInline);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *commands);
    commands.endRenderPass();
    change(commands, target.image, Layout::eColorAttachmentOptimal, Layout::ePresentSrcKHR);
    commands.end();
}

bool Presenter::draw(const Rectangle& where) {
    try {
        if (outOfDate && !buildSwapchain()) return false;
        if (device.waitForFences(*finished, true, patience) != vk::Result::eSuccess) return false;
        const auto [result, index] = swapchain.acquireNextImage(patience, *acquired);
        if (result != vk::Result::eSuccess && result != vk::Result::eSuboptimalKHR) return false;
        const Target& target = targets[index];
        record(target, where);
        device.resetFences(*finished);
        const vk::PipelineStageFlags all = eAllCommands;
        queue.submit(vk::SubmitInfo{}
                         .setWaitSemaphores(*acquired)
                         .setWaitDstStageMask(all)
                         .setCommandBuffers(*commands)
                         .setSignalSemaphores(*target.drawn),
                     *finished);
        const auto presentation =
            vk::PresentInfoKHR{}.setWaitSemaphores(*target.drawn).setSwapchains(*swapchain).setImageIndices(index);
        outOfDate = queue.presentKHR(presentation) == vk::Result::eSuboptimalKHR;
        return true;
    } catch (const vk::OutOfDateKHRError&) {
        outOfDate = true;
        return false;
    }
}

} // namespace vkpm
