/// How wrong a picture is, without knowing the right one.
#pragma once
#include "render/pixel.h"
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace vkpm {

/// Relative errors of beauty: roots of means of e^2 / (truth^2 + 0.01), as relmse is one of squares, over the 98 % of
/// all values, three colours a pixel, that are off least. Among the others are specks, paths that are bright and rare:
/// what these add to a mean over all is luck, and so is any estimate of it. The truth is not known: where a pixel is
/// noisy, the pixels around say how bright it may be, or a pixel that is too bright by chance would pass for a bright
/// one with little error.
struct ErrorEstimate {
    double noise = 0;         // standard errors of the means of passes
    double bias = 0;          // blur of the gathers
    double error = 0;         // both, and a margin: the true error is below with a probability of 0.9
    double least = 0;         // both, less a margin: it is above with that probability
    double whole = 0;         // noise and bias of all pixels, without a margin
    std::uint64_t specks = 0; // pixels whose standard error is above their value, or above 0.1 where that is more
};

/// The part of the values that an error is about.
inline constexpr double KEPT = 0.98;

/// Which values these are, by their squared errors: those with the least, of equal ones the first.
std::vector<bool> keptValues(std::span<const float> squares);

/// The estimate of a picture whose pixels have noise and bias. The margin has three parts: how much the parts of the
/// picture, 8 x 8 of them, differ, since what few pixels decide is less sure than what all of them say; how much the
/// sum of squares of this one picture may be off its expectation, if each pixel's error is normally distributed; and
/// what the estimate itself may be off.
ErrorEstimate estimateError(std::span<const Pixel> pixels, uvec2 size);
/// The same of a picture that need not be in memory as a whole; `rows` gives some of its rows, to any thread.
ErrorEstimate estimateError(const std::function<std::vector<Pixel>(uint firstRow, uint rows)>& rows, uvec2 size);

/// Half the length of the interval around a channel of a pixel that has the truth in it with a probability of 0.9, for
/// noise with `freedom` degrees of freedom.
vec3 halfInterval(const Pixel& pixel, uint freedom);

/// How many standard errors halfInterval() reaches to each side.
double intervalQuantile(uint freedom);

/// "error 0.8 % (noise 0.6 %, bias 0.5 %), 90 % sure, without the worst 2 % (12 specks)".
std::string describe(const ErrorEstimate& estimate);

} // namespace vkpm
