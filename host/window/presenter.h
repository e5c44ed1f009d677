/// What a window shows: a picture, and ImGui over it, on a device and in a swapchain of its own.
#pragma once
#include "shared.h"
#include <glm/glm.hpp>
#include <memory>
#include <span>

struct GLFWwindow;

namespace vkpm {

using glm::ivec2, glm::dvec2, glm::dvec3;

/// A rectangle of the window's pixels, y down.
struct Rectangle {
    ivec2 corner{0};
    ivec2 size{0};
};

class Presenter {
public:
    /// ImGui's context is there, with its fonts. Throws GpuError if no Vulkan device can show this window.
    explicit Presenter(GLFWwindow* window);
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    /// Pixels in 8-bit sRGB that are shown from the next frame on, red in the lowest byte.
    void setPicture(uvec2 size, std::span<const uint> rgba8);

    /// ImGui's frame begins; draw() ends it.
    void beginFrame();
    /// Shows the picture in a rectangle and ImGui's draw data over it. A window without pixels, or one whose last
    /// frames still wait to be shown, is left as it is: false. Throws vk::DeviceLostError.
    bool draw(const Rectangle& where);

private:
    struct Handles;
    std::unique_ptr<Handles> handles;
};

} // namespace vkpm
