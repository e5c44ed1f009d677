// A bounce of photons: see scatter.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compaction.glsl"
#include "scatter.glsl"

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place >= queue.count) return;

    uint slot = args.list.at[queue.first + place];
    Path path = args.paths.at[slot];
    bool arrives;
    PhotonDeposit deposit;
    uint outcome = scatterPhoton(slot, args.bounce, path, args.hits.at[slot], arrives, deposit);
    if (outcome == OUTCOME_GOES_ON) args.paths.at[slot] = path;
    if (arrives) keep(deposit);
    putFlags(args.flags, place, PHOTON_QUEUES, uint(outcome == OUTCOME_GOES_ON) << QUEUE_CONTINUE);
    count(outcome);
}
