/// Error against run time: what a render was off a reference, and what it said itself, pass by pass.
#pragma once
#include "measure/layer_error.h"
#include "output/image.h"
#include "render/error_estimate.h"
#include <array>
#include <filesystem>
#include <map>
#include <optional>

namespace vkpm {

/// A render at some number of passes.
struct ReportRow {
    uint passes = 0;
    double seconds = 0; // of rendering alone
    std::uint64_t rays = 0;
    std::uint64_t photons = 0;                  // emitted
    std::map<std::string, LayerError> layers{}; // of light; empty without a reference
    std::optional<ErrorEstimate> estimate{};    // of beauty
    std::map<std::string, double> noise{};      // of layers of light, over beauty, see layerNoise
};

/// What the page shows of the last picture.
struct ReportPicture {
    const Image& image;
    std::span<const uint> developed; // 8-bit sRGB
    std::span<const Pixel> pixels;
    uint noiseFreedom; // degrees
};

/// A folder with error.csv, written anew with each row, and index.html.
class Report {
public:
    static constexpr std::array<const char*, 2> files{"error.csv", "index.html"};

    /// Makes the folder if there is none. A reference is an EXR file of the same size; without one, rows have estimates
    /// alone. Throws InputError or std::runtime_error with file and cause.
    Report(std::filesystem::path folder, const std::optional<std::filesystem::path>& reference, uvec2 size);

    /// Throws InputError if the reference has another size.
    void requireSize(uvec2 size) const;
    /// Whether a row is due: passes grow by the square root of two.
    static bool due(uint passes);
    /// Adds a row; `image` is measured against the reference, and against the image of the row before.
    void add(ReportRow row, Image image);
    /// Writes the page: the last picture, its errors and intervals, the curves. `facts` are what it shows of the
    /// render.
    void finish(const ReportPicture& picture, const std::vector<std::pair<std::string, std::string>>& facts) const;

    const std::vector<ReportRow>& rows() const { return all; }

private:
    std::filesystem::path folder;
    std::optional<std::filesystem::path> referenceFile;
    std::optional<Image> reference;
    Image last{}; // of the last row
    std::vector<ReportRow> all;
};

/// Standard errors of the layers of light of a mean over `passes` passes, from how it differs from the mean of the
/// first `before` of them: relative to beauty, roots of means over the values of each layer that keptValues() keeps.
std::map<std::string, double> layerNoise(const Image& image, uint passes, const Image& earlier, uint before);

/// Slope of a straight line through the logarithms of ys over those of xs, by least squares; NaN with fewer than two
/// points.
double fittedSlope(std::span<const double> xs, std::span<const double> ys);

} // namespace vkpm
