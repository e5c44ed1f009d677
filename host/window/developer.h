/// Develops pictures beside the window's thread, which a large film would hold up.
#pragma once
#include "window/picture.h"
#include "window/tone.h"
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace vkpm {

/// A picture as it is to be shown.
struct Print {
    std::shared_ptr<const Picture> picture{};
    Tone tone{};
    std::vector<uint> rgba8{};
};

class Developer {
public:
    /// `wake` is called, from another thread, when a print is ready.
    explicit Developer(std::function<void()> wake);
    ~Developer();

    /// Asks for a print, in place of what was asked for before and has not been begun.
    void ask(std::shared_ptr<const Picture> picture, const Tone& tone);
    /// The newest print, once.
    std::optional<Print> take();

private:
    void work();

    std::function<void()> wake;
    std::mutex mutex;
    std::condition_variable changed;
    bool ends = false;
    std::optional<Print> asked, ready;
    std::jthread thread;
};

} // namespace vkpm
