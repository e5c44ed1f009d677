// Paths: photons from the lights and rays from the eye, and the queues that they wait in.
#ifndef SHARED_PATHS_H
#define SHARED_PATHS_H
#include "shared.h"
#include "shared_layers.h"
#include "shared_scene.h"

SHARED_BEGIN

// Sequences of sample points of a pixel.
const uint SAMPLES_EYE = 0u;         // a point for each pass: the place in the pixel and all that follows
const uint SAMPLES_GATHER = 1u;      // one for each gather ray of each pass
const uint FURTHER_PATHS = 1u << 28; // of a pixel: their indices begin there, beyond those of the most passes

/// What a dispatch reads on the device: how many groups, and which part of a list they work on.
struct Queue {
    uint groupsX; // the first three are VkDispatchIndirectCommand
    uint groupsY;
    uint groupsZ;
    uint first; // index into the list
    uint count;
    uint base; // elements that this queue has had in earlier rounds
};
BUFFER(Queue)

/// A ray under way, of a photon or from the eye.
struct Path {
    vec3 origin;
    vec3 direction;
    vec3 throughput; // photon: its colour, relative to the flux per photon; eye: weight of the radiance it finds
    float distanceSinceDiffuse; // since the last diffuse or wide vertex
    uint from;                  // primitive that the ray leaves, or NONE
    uint flags;                 // PATH_..., and the number of diffuse and wide vertices from bit PATH_DIFFUSE_SHIFT on
    uint media;                 // that the ray is in, see media.glsl
};
const uint PATH_EYE_SPECULAR = 1u;               // eye: the event at the first vertex was specular or glossy
const uint PATH_SPECULAR = 2u;                   // one specular or glossy event since the last diffuse one
const uint PATH_SPECULARS = 63u * PATH_SPECULAR; // all of these that are counted
const uint PATH_THROUGH = 1u << 7;               // goes through a smooth mesh, see terminator.glsl
const uint PATH_NARROW = 1u << 8; // eye, of scenes with wide lobes: PATH_SPECULARS since the last wide event
const uint PATH_WIDE = 1u << 9;   // eye: the last event but for those was wide
const uint PATH_ASKED = 1u << 10; // eye: and photons have what comes to that vertex by narrow lobes
const uint PATH_DIFFUSE_SHIFT = 11u;
const uint MAX_DIFFUSE = 2047u;  // eye: vertices that are counted, wide ones among them
const uint PATH_PDF_SHIFT = 22u; // eye, of scenes with glossy lobes or a sky: density of the last event, see packPdf
const uint PATH_PDF_MASK = 0xffc00000u;
BUFFER(Path)

/// Where a ray ends: distance in units of its direction's length, primitive or NONE, barycentric weights of b and c.
struct Hit {
    float t;
    uint primitive;
    vec2 weights;
};
BUFFER(Hit)

/// What the host reads after a step: counters.
struct Status {
    uint deposits;                    // photons for the map, whether there was room or not
    uint absorbed;                    // photons
    uint escaped;                     // photons that left the scene or missed what they were aimed at
    uint rays;                        // of photons
    uint nonfinite[LAYER_COUNT + 1u]; // samples by layer, and photons
};
const uint NONFINITE_PHOTON = LAYER_COUNT;
const uint MAX_BOUNCES = 10000u; // of a path
BUFFER(Status)

// Bits of a path's flags after a step; bit k puts the path into queue k.
const uint QUEUE_CONTINUE = 0u;
const uint PHOTON_QUEUES = 1u;
const uint QUEUE_SHADOW = 1u; // eye
const uint QUEUE_CAUSTIC = 2u;
const uint QUEUE_GLOBAL = 3u;
const uint EYE_QUEUES = 4u;

struct TraceArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(Hit) hits;
    PTR(Queue) queue;
    PTR(uint) list;
};

const uint COMPACTION_BLOCK = 4096u; // places of a list that a group compacts
const uint MAX_COMPACTION_BLOCKS = 1024u;
const uint COMPACTION_SUMS = MAX_COMPACTION_BLOCKS * EYE_QUEUES; // words before the flags

/// How far the paths of a batch have come.
struct PathRounds {
    uint rounds;     // after which paths went on
    uint unfinished; // 1: some would have gone on after the last round
};
BUFFER(PathRounds)

struct CompactArgs {
    PTR(Queue) queues; // one per kind; the first is the one that is compacted. Then that of the groups which do that
    PTR(uint) list;
    PTR(uint) flags; // see compaction.glsl
    PTR(Queue) nextQueues;
    PTR(uint) nextList;
    PTR(uint) nextFlags;          // its sums become 0
    ADDRESS(PathRounds) progress; // 0: nobody asks
    uint kinds;
    uint round;  // of paths, the first is 1
    uint isLast; // 1: no path should go on
};

SHARED_END
#endif
