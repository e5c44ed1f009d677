/// vkpm view: the render in a window, progressively.
#include "commands.h"
#include "output/interrupt.h"
#include "window/viewer.h"
#include <cstdio>
#include <fmt/format.h>

namespace vkpm {

const double patience = 0.4;     // seconds to wait for the size of the film, that the window takes
const uvec2 usualSize{512, 512}; // if that takes longer
const uint leastHeight = 690;    // for the panel

int view(const Options& options) {
    const auto start = Clock::now();
    EventLog log(options.log, options.resume);
    Window window;
    RenderThread thread(options, log, Window::wake);
    const uvec2 film = options.size ? *options.size : thread.waitForSize(patience).value_or(usualSize);
    if (!thread.ended()) {
        window.open(fmt::format("{} - vkpm", options.scene.filename().string()), {film.x + uint(panelWidth(1)), std::max(film.y, leastHeight)});
        Viewer(options, window, thread, log, start).run();
        window.hide();
    }
    const bool saved = thread.close();
    if (!saved && !options.quiet) std::fputs("vkpm: no pass was finished, nothing is saved\n", stderr);
    return interrupted() ? 130 : 0;
}

} // namespace vkpm
