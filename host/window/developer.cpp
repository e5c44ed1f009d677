/// A thread that develops the picture that was asked for last.
#include "window/developer.h"
#include <utility>

namespace vkpm {

Developer::Developer(std::function<void()> call) : wake(std::move(call)), thread([this] { work(); }) {}

Developer::~Developer() {
    const std::lock_guard lock(mutex);
    ends = true;
    changed.notify_all();
}

void Developer::ask(std::shared_ptr<const Picture> picture, const Tone& tone) {
    const std::lock_guard lock(mutex);
    asked = Print{std::move(picture), tone};
    changed.notify_all();
}

std::optional<Print> Developer::take() {
    const std::lock_guard lock(mutex);
    return std::exchange(ready, {});
}

void Developer::work() {
    while (true) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return ends || asked; });
        if (ends) return;
        Print print = *std::exchange(asked, {});
        lock.unlock();
        print.rgba8 = develop(print.picture->pixels, print.tone);
        lock.lock();
        ready = std::move(print);
        lock.unlock();
        wake();
    }
}

} // namespace vkpm
