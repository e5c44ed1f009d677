/// Ctrl-C as a wish that the render loop looks at between passes.
#include "output/interrupt.h"
#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <unistd.h>

namespace vkpm {
namespace {

std::atomic<bool> flag{false};
static_assert(std::atomic<bool>::is_always_lock_free);

bool terminal = false; // set before the handler is installed

/// Calls nothing but what POSIX allows in a signal handler.
void onSignal(int) {
    const int saved = errno;
    flag = true;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);

    // On a terminal the cursor may stand behind a progress bar: begin a new line.
    std::string_view text = "\nvkpm: interrupted: finishing this pass, then saving; once more stops at once\n";
    if (!terminal) text.remove_prefix(1);
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    errno = saved;
}

} // namespace

void catchInterrupts() {
    terminal = ::isatty(STDERR_FILENO) == 1;
    struct sigaction action {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART;
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return flag; }

} // namespace vkpm
