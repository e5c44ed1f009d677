// Puts the photons of a batch into the map's order, whatever order they arrived in; those for which there is room.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "shared_paths.h"
#include "shared_photons.h"

ARGS(StorePhotonsArgs)

void main() {
    uint i = threadIndex();
    if (i >= min(args.status.at[0].deposits, args.depositCapacity)) return;
    PhotonDeposit deposit = args.deposits.at[i];
    uint place = args.offsets.at[deposit.slot] + deposit.index;
    if (place >= args.photonCapacity) return;
    Photon photon = deposit.photon;
    if (!isFinite(photon.color) || !isFinite(photon.position)) {
        atomicAdd(args.status.at[0].nonfinite[NONFINITE_PHOTON], 1u);
        photon.color = vec3(0.0);
    }
    args.photons.at[place] = photon;
}
