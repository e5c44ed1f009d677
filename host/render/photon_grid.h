/// The sorted spatial hash grid over photons.
#pragma once
#include "render/sort.h"

namespace vkpm {

/// Photons in the order of their grid cells, for gathers within a radius.
class PhotonGrid {
public:
    PhotonGrid(Gpu& gpu, std::string name);

    /// Sorts the first `count` of `photons` into cells for gathers within `radius` (world units).
    /// `photonFlux` is the flux per emitted photon, W; cells are split `levels` times for smaller radii. The result has no
    /// radius field, and is valid until the next build.
    PhotonMap build(const Buffer<Photon>& photons, uint count, float radius, float photonFlux, uint levels = 0);

private:
    Gpu& gpu;
    std::string name;
    Sort sort;
    Buffer<Photon> arranged;
    Buffer<uint> cells;
    Kernel<KeysArgs> keys;
    Kernel<ArrangeArgs> arrange;
    Kernel<CellsArgs> cellStarts;
};

} // namespace vkpm
