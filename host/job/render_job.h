/// A render with what the command line asks for, from the first pass to the saved file; with a window or without.
#pragma once
#include "job/options.h"
#include "job/render_file.h"
#include "measure/report.h"
#include "output/event_log.h"
#include "output/statistics.h"
#include "render/error_estimate.h"
#include "render/renderer.h"
#include "shared_film.h"
#include <chrono>

namespace vkpm {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class RenderJob {
public:
    /// All that it is given has to outlive it. `start` is when the program began to do anything for this render.
    RenderJob(const RenderOptions& options, const Scene& scene, const Settings& settings, Gpu& gpu, EventLog& log,
              Clock::time_point start);

    /// Goes on from what the output holds, if it is there.
    void resume();
    /// The clock of rendering starts.
    void begin();
    /// Throws InputError if what it reports about is a picture of another size.
    void requireSize(uvec2 size) const;
    /// Begins anew after the view of the scene or the size of the settings have changed.
    void restart();

    /// Whether to stop: an end is reached, or the time is nearer now than after another pass.
    bool done() const;
    /// Renders the next pass, with what is due after it: report, estimate, log, checkpoint.
    void renderPass();
    /// The end of rendering: saves, reports, says how much error is left unless the options are quiet. False if there
    /// was no pass to save: an older picture stays.
    bool finish();
    /// Time that was no rendering: neither --time nor reports count it.
    void leaveOut(double seconds) { reporting += seconds; }
    /// Saves what there is.
    void save();

    /// Of the PNG, in stops.
    float exposure() const;
    uint passCount() const { return renderer.film.passCount(); }
    uint restoredPasses() const { return restored; }
    const PassRange& passesWanted() const { return passes; }
    /// Seconds of rendering, those of earlier runs included.
    double seconds() const { return earlierSeconds + elapsed(); }
    std::uint64_t rays() const;
    std::uint64_t photons() const; // emitted
    std::optional<GatherRadii> globalRadii() const;
    std::optional<GatherRadii> causticRadii() const;
    /// Nothing while there are no batches of passes that could differ, if nobody asked for noise, or if photons are
    /// missing.
    std::optional<ErrorEstimate> estimateNow() const;
    /// The last estimate that --target-error asked for, and after how many passes.
    const std::optional<ErrorEstimate>& lastError() const { return error; }
    uint lastErrorPasses() const { return errorPasses; }
    /// What it did so far.
    Statistics statistics() const;

    Renderer renderer;

private:
    void requireSame(const RenderFile& file) const;
    void estimate();
    double elapsed() const { return secondsSince(beginning) - reporting; }
    void openReport();
    void addToReport();
    void finishReport() const;
    void checkpoint();
    void sayWhatIsSaved() const;
    std::uint64_t nonfinite() const;
    bool missesPhotons() const; // whether none of many arrived
    bool isBlack() const;
    void warnOfDarkness();
    void warnOfBlur();
    void tell(const std::string& warning);

    const RenderOptions& options;
    const Scene& scene;
    const Settings& settings;
    Gpu& gpu;
    EventLog& log;
    Clock::time_point start;
    std::string device; // as files and statistics name it
    std::map<std::string, std::string> identity;
    PassRange passes;
    uint savedPasses = 0;      // that the output holds
    uint restored = 0;         // passes that earlier runs rendered,
    double earlierSeconds = 0; // the time they took,
    std::uint64_t earlierNonfinite = 0;
    Clock::time_point beginning{}; // of rendering
    Clock::time_point saved{};     // last checkpoint
    double renderSeconds = 0;
    double reporting = 0;               // time that reports and the like took, no part of rendering
    std::optional<ErrorEstimate> error; // the last estimate
    uint errorPasses = 0;               // that it is of
    bool hopeless = false;              // whether there will be none
    std::optional<Report> report;
};

} // namespace vkpm
