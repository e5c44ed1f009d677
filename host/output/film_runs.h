/// The film's sums as further channels of an image, so that a render can go on from its file or be merged.
#pragma once
#include "output/image.h"
#include "render/pixel.h"
#include "shared_film.h"
#include <span>

namespace vkpm {

/// Adds to some rows of an image the sums of runs of passes as channels: state<i>.* of run i, of what layers (bits by
/// place in layerNames) need, and no more. `passes` of all runs together have the means that `pixels` say. With
/// `exactMeans`, if these are in the file as they are, most sums of the first run are kept as residue0.*: how many
/// floats they are from what the means say, which takes few bytes.
void addRuns(Image& rows, std::span<const Pixel> pixels, std::span<const std::span<const PixelSum>> sums, uint passes,
             uint layers, bool exactMeans);

/// The runs that an image or its header says it has, ascending and adjacent. Throws InputError, without the file's
/// name, if it has none or they make no sense.
std::vector<PassRange> runsOf(const Image& image);

/// "0:16 16:17", as the attribute "runs" has them.
std::string runsText(std::span<const PassRange> runs);

/// The channels that sumsOf() needs of a file with these channels. Throws InputError, without the file's name, if some
/// are missing.
std::vector<std::string> channelsOfSums(const Image& header, std::size_t runs, uint layers);

/// The sums of all runs, of some rows.
std::vector<std::vector<PixelSum>> sumsOf(const Image& rows, std::size_t runs, uint passes, uint layers);

/// "passes 0 to 15", for messages.
std::string describe(PassRange passes);

} // namespace vkpm
