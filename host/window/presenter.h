/// What a window shows: a picture, and ImGui over it, on a device and in a swapchain of its own.
#pragma once
#include "gpu/instance.h"
#include "window/window.h"
#include <span>

namespace vkpm {

class Presenter {
public:
    /// ImGui's context is there, with its fonts. Throws GpuError if no Vulkan device can show this window.
    explicit Presenter(GLFWwindow* window);
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    /// Pixels in 8-bit sRGB that are shown from the next frame on, red in the lowest byte.
    void setPicture(uvec2 size, std::span<const uint> rgba8);
    /// Shows the picture in a rectangle and ImGui's draw data over it. A window without pixels, or one whose last
    /// frames still wait to be shown, is left as it is: false. Throws vk::DeviceLostError.
    bool draw(const Rectangle& where);

private:
    /// An image that the window system shows in its turn.
    struct Target {
        vk::Image image;
        vk::raii::ImageView view;
        vk::raii::Framebuffer framebuffer;
        vk::raii::Semaphore drawn;
    };
    /// An image with memory, and a buffer through which its pixels come.
    struct PictureImage {
        uvec2 size{0};
        vk::raii::DeviceMemory memory{nullptr};
        vk::raii::Image image{nullptr};
        vk::raii::DeviceMemory stagingMemory{nullptr};
        vk::raii::Buffer staging{nullptr};
        void* mapped = nullptr;
        bool changed = false; // the image is not what the buffer holds
    };

    void chooseDevice();
    void createDevice();
    void createRenderPass();
    void startImGui();
    bool buildSwapchain();
    void makePicture(uvec2 size);
    vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) const;
    void record(const Target& target, const Rectangle& where);
    void showPicture(vk::Image target, const Rectangle& where);

    GLFWwindow* window;
    Instance instance;
    vk::raii::SurfaceKHR surface{nullptr};
    vk::raii::PhysicalDevice physical{nullptr};
    std::uint32_t family = 0;
    vk::raii::Device device{nullptr};
    vk::raii::Queue queue{nullptr};
    vk::SurfaceFormatKHR format{};
    vk::raii::CommandPool pool{nullptr};
    vk::raii::CommandBuffer commands{nullptr};
    vk::raii::Fence finished{nullptr}; // the last frame's commands
    vk::raii::Semaphore acquired{nullptr};
    vk::raii::RenderPass renderPass{nullptr};
    vk::raii::DescriptorPool descriptors{nullptr};
    PictureImage picture;
    vk::raii::SwapchainKHR swapchain{nullptr};
    vk::Extent2D extent{};
    std::vector<Target> targets;
    bool outOfDate = true;
    bool imGuiRuns = false;
};

} // namespace vkpm
