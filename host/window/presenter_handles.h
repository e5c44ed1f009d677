/// The Vulkan handles behind Presenter.
#pragma once
#include "gpu/instance.h"
#include "shared_paths.h"
#include "window/presenter.h"
#include <vector>

namespace vkpm {

/// The images that the window system shows in turn, and what is made anew with them.
struct Swapchain {
    vk::raii::SwapchainKHR handle{nullptr};
    vk::Extent2D extent{};
    std::vector<vk::Image> images;
    std::vector<vk::raii::ImageView> views;
    std::vector<vk::raii::Framebuffer> framebuffers;
    std::vector<vk::raii::Semaphore> drawn; // one for each image
};

/// An image with memory, and a buffer through which its pixels come.
struct PictureImage {
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Image image{nullptr};
    vk::raii::DeviceMemory stagingMemory{nullptr};
    vk::raii::Buffer staging{nullptr};
    void* mapped = nullptr;
    uvec2 size{0};
    bool changed = false; // the image is not what the buffer holds
};

struct Presenter::Handles {
    explicit Handles(GLFWwindow* shown);
    ~Handles();

    void chooseDevice();
    void createDevice();
    void createRenderPass();
    void startImGui();

    /// False if the window has no pixels.
    bool buildSwapchain();
    void makePicture(uvec2 size);
    void record(std::uint32_t image, const Rectangle& where);
    void showPicture(vk::Image target, const Rectangle& where);
    void submit(std::uint32_t image);
    bool present(std::uint32_t image);

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
    Swapchain swapchain;
    bool outOfDate = true;
    bool imGuiRuns = false;
};

} // namespace vkpm
