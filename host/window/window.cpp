/// GLFW's window and ImGui's context in it.
#include "window/window.h"
#include "window/presenter.h"
#include <GLFW/glfw3.h>
#include <algorithm>
#include <atomic>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <imgui.h>

namespace vkpm {
namespace {

std::string lastProblem; // as GLFW told it

const char* const fontFile =
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"; // ImGui's own font is not made for dense displays
const float fontSize = 14;
const int maxLosses = 3;

[[noreturn]] void fail(const std::string& call) {
    throw GpuError(fmt::format("{} failed: {}; a window needs a display: vkpm --scene FILE renders without one", call,
                               lastProblem.empty() ? "no cause given" : lastProblem));
}

std::function<void()> saveAtLoss;
std::atomic<bool> displayIsGone{false};

/// Xlib ends the program when this returns.
int onLoss(void*) {
    displayIsGone = true;
    if (const auto save = std::exchange(saveAtLoss, nullptr)) save();
    std::_Exit(1);
}

/// GLFW has loaded Xlib if it shows windows by it; on Wayland a display that goes closes its windows.
void listenForLoss() {
    using Handler = int (*)(void*);
    void* xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (void* set = xlib ? dlsym(xlib, "XSetIOErrorHandler") : nullptr)
        reinterpret_cast<Handler (*)(Handler)>(set)(onLoss);
}

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

} // namespace

Window::Window() {
    glfwSetErrorCallback([](int, const char* text) { lastProblem = text; });
    if (!glfwInit()) fail("glfwInit");
    listenForLoss();
}

void Window::onDisplayLoss(std::function<void()> save) { saveAtLoss = std::move(save); }

Window::~Window() {
    if (ImGui::GetCurrentContext()) {
        presenter.reset();
        if (ImGui::GetIO().BackendPlatformUserData) ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    if (window) glfwDestroyWindow(window);
    glfwTerminate();
}

void Window::open(const std::string& title, uvec2 size) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    uvec2 room{65536};
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
        int x, y, width, height;
        glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
        if (width > 0 && height > 0) room = {width, height};
    }
    size = glm::min(size, room);
    window = glfwCreateWindow(int(size.x), int(size.y), title.c_str(), nullptr, nullptr);
    if (!window) fail("glfwCreateWindow");
    glfwSetWindowUserPointer(window, this);
    listen();
    prepareInterface();
    openPresenter();
}

/// Before ImGui, which calls on what it finds.
void Window::listen() {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
        of(w).queue.push_back({Event::Kind::key, key, action, modifiers, of(w).pointer()});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
        of(w).queue.push_back({Event::Kind::button, button, action, modifiers, of(w).pointer()});
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        of(w).queue.push_back({.kind = Event::Kind::move, .position = of(w).inPixels(x, y)});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) {
        of(w).queue.push_back({.kind = Event::Kind::scroll, .position = of(w).pointer(), .scroll = y});
    });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float x, float) { of(w).density = x; });
}

void Window::prepareInterface() {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window, &x, &y);
    density = std::max(x, 0.5f);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForVulkan(window, true);
}

/// With fonts and measures for the density of the display.
void Window::openPresenter() {
    presenter.reset();
    ImGui::GetStyle() = ImGuiStyle();
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.WindowPadding = {12, 10};
    style.FramePadding = {6, 2};
    style.ItemSpacing = {8, 5};
    style.Colors[ImGuiCol_WindowBg] = {0.13f, 0.13f, 0.145f, 1};
    style.Colors[ImGuiCol_Header] = {0.22f, 0.27f, 0.34f, 1};
    style.ScaleAllSizes(density);
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    if (std::filesystem::exists(fontFile)) {
        fonts.AddFontFromFileTTF(fontFile, std::round(fontSize * density));
    } else {
        ImFontConfig config;
        config.SizePixels = std::round(13 * density);
        fonts.AddFontDefault(&config);
    }
    presenter = std::make_unique<Presenter>(window);
    if (pictureSize.x > 0) presenter->setPicture(pictureSize, picture);
}

void Window::hide() {
    glfwHideWindow(window);
    glfwPollEvents();
}

void Window::wait(double seconds) {
    const float before = density;
    if (seconds > 0) glfwWaitEventsTimeout(seconds);
    else glfwPollEvents();
    if (density != before) openPresenter();
}

void Window::wake() {
    if (!displayIsGone) glfwPostEmptyEvent();
}

bool Window::closed() const { return glfwWindowShouldClose(window); }
void Window::close() { glfwSetWindowShouldClose(window, GLFW_TRUE); }
void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window, title.c_str()); }
void Window::copy(const std::string& text) { glfwSetClipboardString(window, text.c_str()); }

uvec2 Window::size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return {width, height};
}

/// Where a display counts in other units than pixels.
dvec2 Window::inPixels(double x, double y) const {
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    return width > 0 && height > 0 ? dvec2(x, y) * dvec2(size()) / dvec2(width, height) : dvec2(0);
}

dvec2 Window::pointer() const {
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    return inPixels(x, y);
}

void Window::setPicture(uvec2 size, std::vector<uint> rgba8) {
    pictureSize = size;
    picture = std::move(rgba8);
    presenter->setPicture(pictureSize, picture);
}

bool Window::draw(const Rectangle& where, const std::function<void()>& interface) {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    interface();
    ImGui::Render();
    if (glfwGetWindowAttrib(window, GLFW_ICONIFIED)) return true;
    try {
        if (!presenter->draw(where)) return size().x == 0;
        losses = 0;
        return true;
    } catch (const vk::DeviceLostError& lost) {
        if (++losses > maxLosses)
            throw GpuError(fmt::format(
                "drawing the window failed: {}; another program may have hung or reset the device", lost.what()));
        openPresenter();
        return false;
    }
}

} // namespace vkpm
