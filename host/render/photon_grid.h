/// The sorted spatial hash grid over photons.
#pragma once
#include "render/sort.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include "shared_sort.h"
#include <optional>

namespace vkpm {

/// Photons in the order of their grid cells, for gathers within a radius.
class PhotonGrid {
public:
    /// Where cells are split, keys have at least `blockBits` bits for the block.
    PhotonGrid(Gpu& gpu, std::string name, uint blockBits = 6);

    /// Records the sort of the first `count` of `photons` into cells for gathers within `radius`.
    /// `photonFlux` is the flux per emitted photon, W; cells are split `levels` times for smaller radii. The result has
    /// no radius field, and is valid until the next one.
    PhotonMap record(Recording& recording, const Buffer<Photon>& photons, uint count, float radius, float photonFlux,
                     uint levels = 0);
    /// Thins overfull cells (see cell_thinning.glsl), if what was recorded, and submitted since, has any.
    void thin(const Buffer<Photon>& photons, uint count, uint pass);
    /// Records, submits, and thins what is the map of a pass; without one, all photons are there.
    PhotonMap build(const Buffer<Photon>& photons, uint count, float radius, float photonFlux, uint levels = 0,
                    std::optional<uint> pass = {});

private:
    /// What thinning needs, if any cell ever is overfull.
    struct Thinning {
        Kernel<MarkKeptArgs> crowd;
        Kernel<ScanArgs> scan;
        Kernel<ThinCellsArgs> thin;
        Buffer<Queue> whole;
    };

    Gpu& gpu;
    std::string name;
    uint blockBits;
    Sort sort;
    Buffer<Photon> arranged;
    Buffer<uint> cells;
    Kernel<KeysArgs> keys;
    Kernel<ReorderPhotonsArgs> arrange;
    Kernel<CellsArgs> cellStarts;
    Buffer<uint> overfull;
    uint isOverfull = 0; // whether any cell is
    std::optional<Thinning> thinning;
};

} // namespace vkpm
