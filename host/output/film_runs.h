/// The film's sums as further channels of an image, so that a render can go on from its file or be merged.
#pragma once
#include "output/image.h"
#include "render/pixel.h"
#include <span>

namespace vkpm {

/// Adds the sums of a run of passes as the channels state<i>.*, i the number of runs that the image has already, and
/// the run to the attribute "runs"; what layers (bits by place in layerNames) need, and no more.
void addRun(Image& image, PassRange passes, std::span<const PixelSum> sums, uint layers);

/// The runs that an image or its header says it has, ascending and adjacent. Throws InputError, without the file's
/// name, if it has none or they make no sense.
std::vector<PassRange> runsOf(const Image& image);

/// The sums of the run of an index, of the layers that the file was asked for. Throws InputError, without the file's name, if channels are missing.
std::vector<PixelSum> sumsOf(const Image& image, std::size_t run, uint layers);

/// "passes 0 to 15", for messages.
std::string describe(PassRange passes);

} // namespace vkpm
