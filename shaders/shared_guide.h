// Where the eye looks, and what is useful there.
#ifndef SHARED_GUIDE_H
#define SHARED_GUIDE_H
#include "shared.h"
#include "shared_camera.h"

SHARED_BEGIN

const uint VISIBLE_CELL_WORDS =
    1u << 18; // of a set of cells, see visible_cells.glsl; one more has a bit for each level in use

struct MarkVisibleArgs {
    PhotonMap map;
    PTR(Query) queries;
    PTR(Queue) queue;
    PTR(uint) list;
    PTR(uint) marks;
    float cellWidth; // of the finest level
    float reach;     // part of a query's footprint that it marks, if that is more than the map's radius there
};

/// What a light sample brings to a place.
struct LightContribution {
    vec2 numbers; // that chose the sample on its light
    float value;  // luminance
};
BUFFER(LightContribution)

struct LightContributionArgs {
    PTR(DeviceScene) scene;
    PTR(Split) splits;
    PTR(LightContribution) values; // [split][question to it]
    uint count;                    // of values
    uint each;                     // questions to a split
    uint stride;                   // one split of so many is asked
    uint seed;
    uint light;  // what it brings to a white surface, again and again; NONE: lights in turn
    uint guided; // 1: directions of the sky by the light guide
};

struct PhotonContributionArgs {
    PTR(Photon) photons;
    PTR(uint) offsets; // of the paths' photons
    PTR(uint) marks;
    PTR(PrimarySample) starts;
    uint count; // of paths
    float cellWidth;
};

SHARED_END
#endif
