/// vkpm view: the render in a window, progressively.
#include "commands/commands.h"
#include "interrupt.h"
#include "output/messages.h"
#include "window/viewer.h"

namespace vkpm {

const double patience = 0.4;     // seconds to wait for the size of the film, that the window takes
const uvec2 usualSize{512, 512}; // if that takes longer
const uint minHeight = 690;      // for the panel

/// Until the window is closed, the program interrupted or the thread has ended.
static void show(const RenderOptions& options, RenderThread& thread, EventLog& log, Window& window,
                 Clock::time_point start) {
    const uvec2 film = options.size ? *options.size : thread.waitForSize(patience).value_or(usualSize);
    if (thread.ended()) return;
    window.open(fmt::format("{} - vkpm", options.scene.filename().string()),
                {film.x + uint(panelWidth(1)), std::max(film.y, minHeight)});
    Viewer(options, window, thread, log, start).run();
    window.hide();
}

/// Ends the render, saves it, and says so where the window cannot any more.
static void saveAfterLoss(const RenderOptions& options, RenderThread& thread) {
    if (thread.close()) say("{} has the passes that were finished", options.output.string());
    else say("no pass was finished, nothing is saved");
}

int execute(const ViewOptions& options) {
    const auto start = Clock::now();
    onInterrupt("interrupted before the first pass: nothing to save", true);
    EventLog log(options.log, options.resume);
    Window window;
    RenderThread thread(options, log, Window::wake);
    Window::onDisplayLoss([&] {
        say("the display is gone: finishing this pass, then saving");
        try {
            saveAfterLoss(options, thread);
        } catch (const std::exception& error) {
            say("{}", error.what());
        }
    });
    try {
        show(options, thread, log, window, start);
    } catch (const std::exception&) { // of the window: what was rendered is not to go with it
        Window::onDisplayLoss(nullptr);
        saveAfterLoss(options, thread);
        throw;
    }
    Window::onDisplayLoss(nullptr);
    const bool saved = thread.close();
    if (!saved && !options.quiet) say("no pass was finished, nothing is saved");
    return interrupted() ? 130 : 0;
}

} // namespace vkpm
