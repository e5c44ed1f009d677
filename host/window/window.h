/// A window of the desktop: its events, and frames with a picture and ImGui over it.
#pragma once
#include "shared.h"
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace vkpm {

using glm::ivec2, glm::dvec2, glm::dvec3;

class Presenter;

/// A rectangle of the window's pixels, y down.
struct Rectangle {
    ivec2 corner{0};
    ivec2 size{0};
};

/// What came from keyboard or mouse, in the order in which it came. Keys, buttons, modifiers and actions are GLFW's
/// numbers.
struct Event {
    enum class Kind { key, button, move, scroll } kind;
    int code = 0;   // key or button
    int action = 0; // pressed, repeated, released
    int modifiers = 0;
    dvec2 position{0}; // of the pointer, in pixels of the window
    double scroll = 0; // steps, up is positive
};

class Window {
public:
    /// Connects to the display. Throws GpuError, saying what needs none, if there is no display.
    Window();
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What is to be done when the display goes and takes the program with it (exit code 1): to save. It is called
    /// once, and may not draw.
    static void onDisplayLoss(std::function<void()> save);
    /// Appears, with room for so many of its pixels at a usual resolution. Throws GpuError.
    void open(const std::string& title, uvec2 size);
    void hide();

    /// Waits for events, at most so many seconds; events() has what came.
    void wait(double seconds);
    std::vector<Event> events() { return std::exchange(queue, {}); }
    /// Ends a wait; from any thread.
    static void wake();

    bool closed() const;
    void close();
    uvec2 size() const; // pixels
    dvec2 pointer() const;
    /// Pixels to a point of the interface: 1, or more on a dense display.
    float scale() const { return density; }

    void setTitle(const std::string& title);
    void copy(const std::string& text); // to the clipboard
    /// The picture of the next frames.
    void setPicture(uvec2 size, std::vector<uint> rgba8);
    /// Draws a frame: the picture in a rectangle, and what `interface` makes with ImGui. False if it has to be drawn
    /// again, since the display was not ready.
    bool draw(const Rectangle& where, const std::function<void()>& interface);

private:
    void listen();
    void prepareInterface();
    void openPresenter();
    dvec2 inPixels(double x, double y) const;

    GLFWwindow* window = nullptr;
    float density = 1;
    std::vector<Event> queue;
    std::unique_ptr<Presenter> presenter;
    uvec2 pictureSize{0};
    std::vector<uint> picture; // kept for a device that has to be opened anew
    int losses = 0;            // of the device, one after another
};

} // namespace vkpm
