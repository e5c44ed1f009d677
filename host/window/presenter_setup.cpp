/// The window's device, render pass, swapchain and picture: creating them.
#include "window/presenter_handles.h"
#include <GLFW/glfw3.h>
#include <algorithm>
#include <backends/imgui_impl_vulkan.h>

namespace vkpm {
namespace {

std::span<const char* const> surfaceExtensions() {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (!names) throw GpuError(std::string("no Vulkan driver can draw in a window of this display; ") + installHint);
    return {names, count};
}

int rankOf(vk::PhysicalDeviceType type) {
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

std::uint32_t memoryType(const vk::raii::PhysicalDevice& device, std::uint32_t allowed,
                         vk::MemoryPropertyFlags wanted) {
    const auto memory = device.getMemoryProperties();
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; i++)
        if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    throw GpuError("no memory type of the device fits the window's picture");
}

} // namespace

Presenter::Handles::Handles(GLFWwindow* shown) : window(shown), instance(surfaceExtensions()) {
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

Presenter::Handles::~Handles() {
    if (*device) vkDeviceWaitIdle(*device); // a lost device is idle, too
    if (imGuiRuns) ImGui_ImplVulkan_Shutdown();
}

void Presenter::Handles::chooseDevice() {
    auto devices = instance.handle.enumeratePhysicalDevices();
    std::erase_if(devices, [&](const auto& d) {
        return !hasSwapchains(d) || showingFamily(d, surface) < 0 || d.getProperties().apiVersion < VK_API_VERSION_1_3;
    });
    if (devices.empty())
        throw GpuError(std::string("no Vulkan 1.3 device can show a window on this display; ") + installHint);
    physical = std::move(
        *std::ranges::min_element(devices, {}, [](const auto& d) { return rankOf(d.getProperties().deviceType); }));
    family = static_cast<std::uint32_t>(showingFamily(physical, surface));

    // Pixels come encoded in sRGB, so that the format is to leave them as they are.
    const auto formats = physical.getSurfaceFormatsKHR(*surface);
    const auto plain = std::ranges::find_if(formats, [](const auto& f) {
        return f.format == vk::Format::eB8G8R8A8Unorm || f.format == vk::Format::eR8G8B8A8Unorm;
    });
    format = plain == formats.end() ? formats.at(0) : *plain;
}

void Presenter::Handles::createDevice() {
    const float priority = 1;
    const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    const vk::DeviceQueueCreateInfo queues{.queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    const vk::PhysicalDeviceVulkan13Features v13{.synchronization2 = true};
    device = vk::raii::Device(physical, vk::DeviceCreateInfo{.pNext = &v13,
                                                             .queueCreateInfoCount = 1,
                                                             .pQueueCreateInfos = &queues,
                                                             .enabledExtensionCount = 1,
                                                             .ppEnabledExtensionNames = &extension});
    queue = device.getQueue(family, 0);
    pool = device.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = family});
    commands = std::move(device.allocateCommandBuffers(
        {.commandPool = *pool, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1})[0]);
    finished = device.createFence({.flags = vk::FenceCreateFlagBits::eSignaled});
    acquired = device.createSemaphore({});
}

/// ImGui's draws go over what the commands before have put there.
void Presenter::Handles::createRenderPass() {
    const auto layout = vk::ImageLayout::eColorAttachmentOptimal;
    const vk::AttachmentDescription attachment{.format = format.format,
                                               .samples = vk::SampleCountFlagBits::e1,
                                               .loadOp = vk::AttachmentLoadOp::eLoad,
                                               .storeOp = vk::AttachmentStoreOp::eStore,
                                               .stencilLoadOp = vk::AttachmentLoadOp::eDontCare,
                                               .stencilStoreOp = vk::AttachmentStoreOp::eDontCare,
                                               .initialLayout = layout,
                                               .finalLayout = layout};
    const vk::AttachmentReference reference{.attachment = 0, .layout = layout};
    const vk::SubpassDescription subpass{.pipelineBindPoint = vk::PipelineBindPoint::eGraphics,
                                         .colorAttachmentCount = 1,
                                         .pColorAttachments = &reference};
    renderPass = device.createRenderPass(
        {.attachmentCount = 1, .pAttachments = &attachment, .subpassCount = 1, .pSubpasses = &subpass});
}

void Presenter::Handles::startImGui() {
    const vk::DescriptorPoolSize size{.type = vk::DescriptorType::eCombinedImageSampler, .descriptorCount = 1};
    descriptors = device.createDescriptorPool({.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                               .maxSets = 1,
                                               .poolSizeCount = 1,
                                               .pPoolSizes = &size});
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
    const vk::CommandBuffer recorded = *commands;
    queue.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &recorded});
    queue.waitIdle();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

bool Presenter::Handles::buildSwapchain() {
    device.waitIdle();
    const auto can = physical.getSurfaceCapabilitiesKHR(*surface);
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    const bool chosen = can.currentExtent.width == UINT32_MAX;
    const vk::Extent2D extent =
        chosen ? vk::Extent2D{std::clamp(std::uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width),
                              std::clamp(std::uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height)}
               : can.currentExtent;
    if (extent.width == 0 || extent.height == 0) return false;

    // The newest picture, without waiting for the display if it can be had.
    const auto modes = physical.getSurfacePresentModesKHR(*surface);
    const auto has = [&](vk::PresentModeKHR mode) { return std::ranges::find(modes, mode) != modes.end(); };
    const auto mode = has(vk::PresentModeKHR::eMailbox)     ? vk::PresentModeKHR::eMailbox
                      : has(vk::PresentModeKHR::eImmediate) ? vk::PresentModeKHR::eImmediate
                                                            : vk::PresentModeKHR::eFifo;
    const std::uint32_t most = can.maxImageCount ? can.maxImageCount : UINT32_MAX;
    const vk::raii::SwapchainKHR old = std::move(swapchain.handle);
    swapchain = {};
    swapchain.extent = extent;
    swapchain.handle = device.createSwapchainKHR(
        {.surface = *surface,
         .minImageCount = std::min(can.minImageCount + 1, most),
         .imageFormat = format.format,
         .imageColorSpace = format.colorSpace,
         .imageExtent = extent,
         .imageArrayLayers = 1,
         .imageUsage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferDst,
         .imageSharingMode = vk::SharingMode::eExclusive,
         .preTransform = can.currentTransform,
         .compositeAlpha = vk::CompositeAlphaFlagBitsKHR::eOpaque,
         .presentMode = mode,
         .clipped = true,
         .oldSwapchain = *old});
    for (const VkImage image : swapchain.handle.getImages()) {
        swapchain.images.push_back(image);
        swapchain.views.push_back(
            device.createImageView({.image = image,
                                    .viewType = vk::ImageViewType::e2D,
                                    .format = format.format,
                                    .subresourceRange = {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}}));
        const vk::ImageView view = *swapchain.views.back();
        swapchain.framebuffers.push_back(device.createFramebuffer({.renderPass = *renderPass,
                                                                   .attachmentCount = 1,
                                                                   .pAttachments = &view,
                                                                   .width = extent.width,
                                                                   .height = extent.height,
                                                                   .layers = 1}));
        swapchain.drawn.push_back(device.createSemaphore({}));
    }
    outOfDate = false;
    return true;
}

void Presenter::Handles::makePicture(uvec2 size) {
    const std::uint64_t bytes = std::uint64_t(size.x) * size.y * sizeof(uint);
    PictureImage next{.size = size};
    const auto allocate = [&](const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) {
        return device.allocateMemory(
            {.allocationSize = needs.size, .memoryTypeIndex = memoryType(physical, needs.memoryTypeBits, wanted)});
    };
    next.image =
        device.createImage({.imageType = vk::ImageType::e2D,
                            .format = vk::Format::eR8G8B8A8Unorm,
                            .extent = {size.x, size.y, 1},
                            .mipLevels = 1,
                            .arrayLayers = 1,
                            .samples = vk::SampleCountFlagBits::e1,
                            .tiling = vk::ImageTiling::eOptimal,
                            .usage = vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst});
    next.memory = allocate(next.image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal);
    next.image.bindMemory(*next.memory, 0);
    next.staging = device.createBuffer({.size = bytes, .usage = vk::BufferUsageFlagBits::eTransferSrc});
    next.stagingMemory = allocate(next.staging.getMemoryRequirements(),
                                  vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    next.staging.bindMemory(*next.stagingMemory, 0);
    next.mapped = next.stagingMemory.mapMemory(0, VK_WHOLE_SIZE);
    picture = std::move(next);
}

} // namespace vkpm
