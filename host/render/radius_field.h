/// First gather radii by place: small where photons are dense, wide where they are inverseDensity.
#pragma once
#include "gpu/recording.h"
#include "scene/scene.h"
#include "shared_photons.h"

namespace vkpm {

/// A hashed grid over the scene with a radius for each cell, measured in the photon map of a pilot pass.
class RadiusField {
public:
    explicit RadiusField(Gpu& gpu);

    /// Measures where discs hold about `perDisc` of the map's `count` photons; none is wider than the map's radius,
    /// none narrower than that over 2^levels. One photon of `stride` is looked at. If the map is partial, the field is
    /// known where most photons want radii below the map's, and around, farther than wider discs reach.
    void measure(const PhotonMap& pilot, uint count, float perDisc, uint stride = 1);
    /// Makes gathers in a map use the field.
    void apply(PhotonMap& map) const;

    /// Binary logarithms of radii in units of the pilot's, at most 0: the smallest, that of most photons, the greatest.
    float smallest = 0;
    float median = 0;
    float greatest = 0;
    /// Parts of the photons: those where the field is known; those that want less than half of the narrowest radius.
    float known = 0;
    float overfull = 0;

private:
    void measureNarrow(PhotonMap pilot, uint count, float perDisc);
    Gpu& gpu;
    float cellsPerUnit = 0;
    bool partial = false;
    Buffer<float> values;
    Kernel<MeasureRadiusArgs> pilotKernel;
};

} // namespace vkpm
