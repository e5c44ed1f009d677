// Photons, their emission, and the photon grid.
#ifndef SHARED_PHOTONS_H
#define SHARED_PHOTONS_H
#include "shared.h"
#include "shared_paths.h"

SHARED_BEGIN

/// A photon where it arrived at a diffuse surface, or a wide lobe.
struct Photon {
    vec3 position;
    vec3 color;     // relative to the flux per photon; for signs see density.glsl
    uint normal;    // geometric, on the side of arrival, octahedral 2 x 16 bit
    uint direction; // from which it came, likewise
};
BUFFER(Photon)

/// A deposit in the order of arrival; path and number of the deposit give its place in the map.
struct PhotonDeposit {
    Photon photon;
    uint slot;
    uint index;
};
BUFFER(PhotonDeposit)

// The numbers in [0, 1) that start a photon: light, side, two for the place on the light, two for the direction,
// target.
const uint PRIMARY_DIMENSIONS = 7u;
const uint PRIMARY_LIGHT = 0u;
const uint PRIMARY_SIDE = 1u;
const uint PRIMARY_POSITION = 2u;
const uint PRIMARY_DIRECTION = 4u;
const uint PRIMARY_TARGET = 6u;

/// How a photon was started, and how useful it was.
struct PrimarySample {
    float numbers[PRIMARY_DIMENSIONS];
    float weight;         // of its flux, had the numbers been uniform
    float inverseDensity; // uniform density over that of the numbers
    uint stored;          // how often it was stored,
    uint seen;            // and how often where the eye looks,
    vec3 place;           // there first
};
BUFFER(PrimarySample)

struct EmitArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(uint) list;
    PTR(uint) flags;
    PTR(uint) counts; // of deposits, by path
    PTR(Status) status;
    ADDRESS(GuideNode) guide;      // 0: the numbers are uniform
    ADDRESS(PrimarySample) starts; // 0: nobody asks
    uint firstPhoton;
    uint count;
    uint pass;
    uint seed;
    uint caustic; // 1: aimed at the targets
};

struct ScatterArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(PhotonDeposit) deposits;
    PTR(uint) counts; // of deposits, by path
    PTR(Queue) queue;
    PTR(uint) list;
    PTR(uint) flags; // by place in the list
    PTR(Status) status;
    uint capacity; // of deposits
    uint firstPhoton;
    uint pass;
    uint seed;
    uint bounce;  // the first
    uint bounces; // how many at most
    uint caustic;
    uint connected; // 1: to the camera; at wide lobes photons keep the direction that they come from as their normal,
                    // and their color is over its geometric cosine
};

struct StorePhotonsArgs {
    PTR(PhotonDeposit) deposits;
    PTR(uint) offsets; // of the batch's paths
    PTR(Photon) photons;
    PTR(Status) status;
    uint depositCapacity;
    uint photonCapacity;
};

/// Photons in the order of their cells' keys, where each key starts, and how far to gather.
struct PhotonMap {
    ADDRESS(Photon) photons;
    ADDRESS(uint) cells;  // cellMask + 2 entries
    ADDRESS(float) field; // binary logarithms of radii in units of `radius`, or 1 where unknown
    float cellsPerUnit;   // of the widest cells
    uint cellMask;
    uint levels;        // how often a cell is split into eight
    float radius;       // the greatest
    float shrink;       // gather within this part of the distance of the k-th nearest, or of a pixel at least
    float photonFlux;   // W per photon emitted
    float fieldPerUnit; // 0 if the radius is the same everywhere
    uint partial;       // 1: of narrow discs alone; where the field is unknown, the next map answers
    uint kernel;        // KERNEL_...
    uint nearest;       // the radius is the distance of the k-th nearest; 0: not so
};

#ifdef __cplusplus
static_assert(sizeof(PhotonMap) == 3 * 8 + 10 * 4, "no padding, as GLSL has none");
#endif
const uint MAX_LEVELS = 4u;
const uint FIELD_CELLS = 1u << 16,
           NARROW_FIELD_CELLS = 1u << 22; // of a map, of one of narrow discs alone: hardly two share one
const float PILOT_UNIT = 1024.0;          // a logarithm of 1 in the sums

/// A photon of a pilot, and the radius that it wants.
struct WantedRadius {
    vec3 position;
    float logarithm; // negative binary one, in units of the map's radius; more than its levels: narrower than it has
                     // cells for
};
BUFFER(WantedRadius)

struct MeasureRadiusArgs {
    PhotonMap map;
    PTR(uint)
    sums; // by cell of the field: negative logarithms, photons; then photons whose discs cannot be as narrow as they
          // should
    PTR(WantedRadius) wanted; // in a partial map, in place of sums
    uint count;
    uint stride;   // one photon of so many is looked at
    float perDisc; // photons wanted
};

struct KeysArgs {
    PTR(Photon) photons;
    PTR(uint) keys;
    PTR(uint) values;
    uint count;
    float cellsPerUnit;
    uint levels;
    uint cellMask;
};

struct ReorderPhotonsArgs {
    PTR(Photon) photons;
    PTR(uint) order;
    PTR(Photon) arranged;
    uint count;
};

struct CellsArgs {
    PTR(uint) keys;
    PTR(uint) cells;
    PTR(uint) overfull; // becomes 1 if a cell has more photons than MAX_PHOTONS_PER_CELL
    uint count;
    uint cellMask;
};

const uint MAX_PHOTONS_PER_CELL = 1024u; // photons that a gather reads of a cell at most, see cell_thinning.glsl

struct MarkKeptArgs {
    PTR(uint) keys;
    PTR(uint) cells;
    PTR(uint) kept; // 1 for those that do
    uint count;
    uint pass;
};

struct ThinCellsArgs {
    PTR(Photon) photons;
    PTR(uint) order;
    PTR(uint) keys;
    PTR(uint) cells;
    PTR(uint) places; // prefix sums of MarkKeptArgs.kept
    PTR(Photon) arranged;
    PTR(uint) thinnedKeys;
    uint count;
    uint pass;
};

SHARED_END
#endif
