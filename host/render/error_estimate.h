/// How wrong a picture is, without knowing the right one.
#pragma once
#include "render/pixel.h"
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace vkpm {

/// Relative errors of beauty: roots of means over pixels and channels of e^2 / (truth^2 + 0.01), as relmse is one of
/// squares. The truth is not known: where a pixel is noisy, the pixels around say how bright it may be, or a pixel that
/// is too bright by chance would pass for a bright one with little error.
struct ErrorEstimate {
    double noise = 0; // standard errors of the means of passes
    double bias = 0;  // blur of the gathers
    double error = 0; // both, and a margin: the true error is below with a probability of 0.9
};

/// The estimate of a picture whose pixels have noise and bias. The margin has two parts: how much the parts of the
/// picture, 8 x 8 of them, differ, since what few pixels decide is less sure than what all of them say; and how much
/// the sum of squares of this one picture may be off its expectation, if each pixel's error is normally distributed.
ErrorEstimate estimateError(std::span<const Pixel> pixels, uvec2 size);
/// The same of a picture that need not be in memory as a whole; `rows` gives some of its rows, to any thread.
ErrorEstimate estimateError(const std::function<std::vector<Pixel>(uint firstRow, uint rows)>& rows, uvec2 size);

/// Half the length of the interval around a channel of a pixel that has the truth in it with a probability of 0.9, for
/// noise with `freedom` degrees of freedom.
vec3 halfInterval(const Pixel& pixel, uint freedom);

/// "error 0.8 % (noise 0.6 %, bias 0.5 %), 90 % sure".
std::string describe(const ErrorEstimate& estimate);

} // namespace vkpm
