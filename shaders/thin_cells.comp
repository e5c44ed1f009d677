// Copies the photons that stay when overfull cells are thinned, with the flux of those that do not, and their keys.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "cell_thinning.glsl"
#include "common.glsl"
#include "shared_photons.h"

ARGS(ThinCellsArgs)

void main() {
    uint i = threadIndex();
    if (i >= args.count) return;
    uint weight = weightAfterThinning(args.keys, args.cells, i, args.pass);
    if (weight == 0u) return;
    uint place = args.places.at[i];
    Photon photon = args.photons.at[args.order.at[i]];
    photon.color *= float(weight);
    args.arranged.at[place] = photon;
    args.thinnedKeys.at[place] = args.keys.at[i];
}
