/// Signals to a flag.
#include "interrupt.h"
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <unistd.h>

namespace vkpm {
namespace {

const int interruptedCode = 130;

std::atomic<bool> flag{false};
std::atomic<bool> endsAtOnce{true};
std::atomic<const char*> message{"interrupted"};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<const char*>::is_always_lock_free);

bool terminal = false; // set before the handler is installed

void put(const char* text) { [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text)); }

/// Calls nothing but what POSIX allows in a signal handler.
void onSignal(int) {
    const int saved = errno;
    put(terminal ? "\nvkpm: " : "vkpm: "); // on a terminal the cursor may stand behind a progress bar: begin a new line
    put(message);
    put("\n");
    if (endsAtOnce) ::_exit(interruptedCode);
    flag = true;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGXCPU, SIG_IGN); // it comes each second
    std::signal(SIGHUP, SIG_IGN);  // a terminal that is closed sends it, and its shell once more
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
    ::sigaction(SIGXCPU, &action, nullptr);
    struct sigaction before {};
    ::sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

void onInterrupt(const char* text, bool ends) {
    message = text;
    endsAtOnce = ends;
}

bool interrupted() { return flag; }

} // namespace vkpm
